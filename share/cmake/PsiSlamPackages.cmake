# SPDX-License-Identifier: BSD-3-Clause
# The Debian packages that `cpack -G DEB` makes of a build: psi-slam, the programs; libpsi-slam-dev, the library; and
# psi-slam-mpi, where MPI was found, so that nobody else needs that.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME psi-slam)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL programs development)
if(TARGET psi-slam-sweep-mpi)
  list(APPEND CPACK_COMPONENTS_ALL cluster)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
if(NOT CPACK_DEBIAN_PACKAGE_MAINTAINER)  # who gives packages to others names himself: -D ...="Name <address>"
  set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The developers of psi-slam <psi-slam@localhost>")
endif()
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME psi-slam)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "mrpt-apps")
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION
"psi-slam maps what a wheeled robot records: the scans of a 2D lidar and
the wheel odometry become one consistent floor plan, by graph SLAM with
genetic loop matching. The package holds psi-slam itself, a window that
shows the map being made, and programs that measure how good maps are.")

set(CPACK_DEBIAN_CLUSTER_PACKAGE_NAME psi-slam-mpi)
set(CPACK_DEBIAN_CLUSTER_PACKAGE_SECTION science)
set(CPACK_DEBIAN_CLUSTER_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_CLUSTER_PACKAGE_DEPENDS "psi-slam (= ${PROJECT_VERSION}-1), openmpi-bin")
set(CPACK_COMPONENT_CLUSTER_DESCRIPTION
"Maps many logs with many settings on the ranks of an MPI job: the sweeps of
psi-slam and its benchmark on a cluster.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpsi-slam-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)  # static libraries name none
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libmrpt-dev (>= 1:2.5.8), libeigen3-dev (>= 3.4), libopencv-dev (>= 4.6), libgdal-dev (>= 3.6), \
libnanoflann-dev, nlohmann-json3-dev (>= 3.11), zlib1g-dev, libbz2-dev, liblz4-dev, libzstd-dev, libsqlite3-dev, libssl-dev, \
pkg-config")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"Headers and static libraries of psi-slam, a graph SLAM system for wheeled
robots, with what CMake's find_package needs, and an example.")

# The changelog of the packages; that of the program lies beside it.
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH, where that is set
file(WRITE ${PROJECT_BINARY_DIR}/changelog.Debian
  "psi-slam (${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
  "  * Packed by CPack; changelog.gz says what is new.\n\n"
  " -- ${CPACK_DEBIAN_PACKAGE_MAINTAINER}  ${now}\n")
execute_process(COMMAND gzip --force --best --no-name ${PROJECT_BINARY_DIR}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
foreach(package psi-slam:programs libpsi-slam-dev:development psi-slam-mpi:cluster)
  string(REPLACE ":" ";" package ${package})
  list(GET package 0 name)
  list(GET package 1 component)
  install(FILES ${PROJECT_BINARY_DIR}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
endforeach()

include(CPack)
