# The pipeline with the packages of requirements.lock: an image for clusters whose nodes have no Python of their own.
#
#     docker build --tag twodiscs .
#     docker run --rm --volume "$PWD/results:/twodiscs/results" twodiscs --cores 2
FROM docker.io/library/python:3.11-slim
WORKDIR /twodiscs
COPY requirements.lock .
RUN pip install --no-cache-dir --require-hashes --requirement requirements.lock
COPY pyproject.toml README.md LICENSE CITATION.cff Snakefile ./
COPY config config
COPY paper paper
COPY profiles profiles
COPY src src
COPY workflow workflow
RUN pip install --no-cache-dir --no-deps --no-build-isolation --editable .
# Whoever runs it may have no home: caches are kept here.
ENV HOME=/tmp XDG_CACHE_HOME=/tmp/cache USER=twodiscs
ENTRYPOINT ["snakemake"]
