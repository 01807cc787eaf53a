# Stands for 3dcitydb/citydb-tool and 3dcitydb/impexp, and runs the tests of databases: our loader and tests, built where the program
# was built (the stage `build` of deploy/Dockerfile), in the image of the program, whose libraries they use.
FROM localhost/citymesh-build AS build
RUN apt-get -q update && DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends libgtest-dev libgmock-dev
COPY tests tests
ARG JOBS=
RUN cmake --preset release -DCITYMESH_TESTS=ON "-DCITYMESH_TEST_KINDS=support;integration" \
 && cmake --build --preset release --parallel "${JOBS:-$(nproc)}" --target citymesh_citydb_load integration_citydb \
 && install -D --strip build/release/tests/support/citydb/citymesh_citydb_load /tools/usr/bin/citymesh_citydb_load \
 && install -D --strip build/release/tests/integration/citydb/integration_citydb /tools/usr/bin/integration_citydb

FROM localhost/citymesh AS run
COPY --from=build /tools/ /
COPY deploy/try/load.sh /usr/local/bin/citydb
COPY deploy/try/load.sh /usr/local/bin/impexp
USER 1000:1000
ENTRYPOINT []
