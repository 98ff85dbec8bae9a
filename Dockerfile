# The command in an image: built with the packages of cmake/packages.txt, by ./dev, and shipped with the libraries that
# it needs and nothing else (cmake/make_tarball.sh).
#   docker build -t bodyloom .
#   docker run --rm -v "$PWD:/data" bodyloom run clip.mp4 --out results
FROM debian:12-slim AS build
ENV DEBIAN_FRONTEND=noninteractive
COPY . /source
WORKDIR /source
RUN ./dev models && ./dev build release bodyloom_command
RUN apt-get install -y --no-install-recommends patchelf python3 xz-utils \
    && cmake/make_tarball.sh build/release /out 0 \
    && mkdir /opt/bodyloom \
    && tar -C /opt/bodyloom --strip-components=1 -xJf /out/*.tar.xz

FROM debian:12-slim
COPY --from=build /opt/bodyloom /opt/bodyloom
ENV PATH=/opt/bodyloom/bin:$PATH
WORKDIR /data
ENTRYPOINT ["bodyloom"]
