"""The paper on top of the library ``twodiscs``: its studies, and the pipeline that builds them."""
