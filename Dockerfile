# The pipeline with the packages of requirements.lock. In a clone:
#
#     docker build --tag twodiscs .
#     docker run --rm --volume "$PWD/results:/twodiscs/results" twodiscs --cores 2
#     apptainer build twodiscs.sif docker-daemon:twodiscs:latest    # for the jobs of a cluster
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
