# Boresight for the workers of a study: the wheel on a slim Debian with Python, as an ordinary user.
#
#     .ci/dist dist && docker build --tag boresight .
#     docker run --rm --volume "$PWD:/work" --user "$(id --user):$(id --group)" boresight run argon --frames 0..200 --out /work/run
#
# Not built in continuous integration, which has no container runtime.
FROM python:3.12-slim

COPY dist/boresight-*.whl /tmp/
RUN pip install --no-cache-dir "$(echo /tmp/boresight-*.whl)[dask]" \
    && rm /tmp/boresight-*.whl \
    && useradd --create-home boresight

USER boresight
WORKDIR /home/boresight
ENTRYPOINT ["boresight"]
