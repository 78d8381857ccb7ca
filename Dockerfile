# The program and the Python module on Debian 12.
#
#   docker build -t exitance .
#   docker run --rm -v "$PWD:/work" exitance solve room.obj -o room.h5
FROM debian:12 AS build
COPY . /source
WORKDIR /source
RUN scripts/install_dependencies.sh && scripts/make_packages

FROM debian:12
COPY --from=build /source/build/packages/*.deb /tmp/
RUN apt-get update -q && apt-get install -q -y --no-install-recommends /tmp/*.deb python3-numpy python3-scipy \
    && rm -rf /tmp/*.deb /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["exitance"]
