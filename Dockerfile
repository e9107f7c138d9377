# The pipeline with the packages of requirements.lock. In a clone:
#
#     docker build --tag twodiscs .
#     docker run --rm --user "$(id -u):$(id -g)" --volume "$PWD/results:/twodiscs/results" twodiscs --cores 2
#     apptainer build twodiscs.sif docker-daemon:twodiscs:latest    # for the jobs of a cluster
FROM docker.io/library/python:3.11-slim@sha256:9c900dea9e8fb7e16277c179b555cc72d29a352dbc33cff48ad5a0412fd5bfc7
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
# Any user may run it and keeps the files. Who has no home there has caches here.
RUN useradd twodiscs && mkdir --parents results .snakemake && chmod a+rwx . results .snakemake
ENV HOME=/tmp XDG_CACHE_HOME=/tmp/cache USER=twodiscs
USER twodiscs
ENTRYPOINT ["snakemake"]
