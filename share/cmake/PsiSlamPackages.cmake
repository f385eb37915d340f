# SPDX-License-Identifier: BSD-3-Clause
# Debian packages that `cpack -G DEB` makes from a build:
#   psi-slam          the programs that make, show and evaluate maps
#   psi-slam-bench    the benchmarks, for developers
#   libpsi-slam-dev   the library
#   python3-psi-slam  the Python module, if it is built
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME psi-slam)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
psi_slam_list_packages(packages)
set(CPACK_COMPONENTS_ALL)
foreach(package IN LISTS packages)
  psi_slam_component_of(component ${package})
  list(APPEND CPACK_COMPONENTS_ALL ${component})
endforeach()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
if(NOT CPACK_DEBIAN_PACKAGE_MAINTAINER)  # set it if you publish packages: -D ...="Name <address>"
  file(READ ${PROJECT_SOURCE_DIR}/CITATION.cff citation)
  if(NOT citation MATCHES "\ncontact:\n  - name: \"([^\"]+)\"\n    email: \"([^\"]+)\"\n")
    message(FATAL_ERROR "CITATION.cff names no maintainer: expected an entry `contact` with name and email in quotes")
  endif()
  set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${CMAKE_MATCH_1} <${CMAKE_MATCH_2}>")
endif()
if(NOT CPACK_DEBIAN_PACKAGE_RELEASE)
  set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
endif()
set(this_version "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME psi-slam)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "psi-slam-bench, python3-psi-slam")
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION
"psi-slam makes floor plans from the logs of wheeled robots. It combines the
scans of a 2D lidar and wheel odometry by graph SLAM with genetic loop
matching. The package contains psi-slam, a window that shows how the map
is built, and a program that measures the accuracy of paths.")

set(CPACK_DEBIAN_BENCH_PACKAGE_NAME psi-slam-bench)
set(CPACK_DEBIAN_BENCH_PACKAGE_SECTION science)
set(CPACK_DEBIAN_BENCH_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_BENCH_PACKAGE_DEPENDS "psi-slam ${this_version}")
set(CPACK_DEBIAN_BENCH_PACKAGE_SUGGESTS "mrpt-apps")  # baselines of the Freiburg benchmark
# Earlier versions of psi-slam contained its files.
set(CPACK_DEBIAN_BENCH_PACKAGE_BREAKS "psi-slam (<< ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
set(CPACK_DEBIAN_BENCH_PACKAGE_REPLACES "psi-slam (<< ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
set(CPACK_COMPONENT_BENCH_DESCRIPTION
"Measures accuracy and speed of psi-slam and of its parts: on the logs of the
Freiburg benchmark, on degraded logs and in simulated buildings.")

# The module fits one version of Python only.
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-psi-slam)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
if(TARGET psi_slam_python)
  string(REGEX MATCH "^([0-9]+)[.]([0-9]+)$" version "${PSI_SLAM_PYTHON_VERSION}")
  math(EXPR next "${CMAKE_MATCH_2} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= ${version}), python3 (<< ${CMAKE_MATCH_1}.${next}), python3-numpy")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-pandas")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"Python module of psi-slam, a graph SLAM system for wheeled robots. Maps logs,
or scans from NumPy arrays, and gives poses, loops and the map as arrays.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpsi-slam-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)  # static libraries have no shared-library dependencies
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libmrpt-dev (>= 1:2.5.8), libeigen3-dev (>= 3.4), libopencv-dev (>= 4.6), libgdal-dev (>= 3.6), libpng-dev, zlib1g-dev, \
libbz2-dev, liblzma-dev, liblz4-dev, libzstd-dev, libsqlite3-dev, libssl-dev, libsleef-dev, pkg-config")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"Headers and static libraries of psi-slam, a graph SLAM system for wheeled
robots. Contains the files for CMake's find_package and examples.")

# Changelog of the Debian packages. The changelog of the program is installed beside it.
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)  # uses SOURCE_DATE_EPOCH if it is set
file(WRITE ${PROJECT_BINARY_DIR}/changelog.Debian
  "psi-slam (${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
  "  * Packed by CPack; changelog.gz lists the changes.\n\n"
  " -- ${CPACK_DEBIAN_PACKAGE_MAINTAINER}  ${now}\n")
execute_process(COMMAND gzip --force --best --no-name ${PROJECT_BINARY_DIR}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
foreach(package IN LISTS packages)
  psi_slam_component_of(component ${package})
  install(FILES ${PROJECT_BINARY_DIR}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endforeach()

include(CPack)
