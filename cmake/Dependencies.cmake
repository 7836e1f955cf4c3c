# Every library is a Debian package (packages.txt); all are gathered in one target.
find_package(OpenMP REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(pugixml REQUIRED)
find_package(ZLIB REQUIRED)
find_package(HDF5 REQUIRED COMPONENTS C)
find_path(UDUNITS2_INCLUDE udunits2.h REQUIRED)
find_library(UDUNITS2_LIBRARY udunits2 REQUIRED)
find_path(MUPARSER_INCLUDE muParser.h REQUIRED)
find_library(MUPARSER_LIBRARY muparser REQUIRED)
find_path(CAIRO_INCLUDE cairo.h PATH_SUFFIXES cairo REQUIRED)
find_library(CAIRO_LIBRARY cairo REQUIRED)
find_path(MUMPS_INCLUDE dmumps_c.h REQUIRED)
find_library(MUMPS_LIBRARY dmumps_seq REQUIRED)
find_library(MUMPS_COMPLEX_LIBRARY zmumps_seq REQUIRED)

add_library(riven_dependencies INTERFACE)
target_include_directories(riven_dependencies SYSTEM INTERFACE ${UDUNITS2_INCLUDE} ${MUPARSER_INCLUDE} ${CAIRO_INCLUDE} ${MUMPS_INCLUDE})
target_link_libraries(riven_dependencies INTERFACE
  OpenMP::OpenMP_CXX Eigen3::Eigen fmt::fmt spdlog::spdlog nlohmann_json::nlohmann_json CLI11::CLI11
  tomlplusplus::tomlplusplus pugixml::pugixml ZLIB::ZLIB hdf5::hdf5 ${UDUNITS2_LIBRARY} ${MUPARSER_LIBRARY}
  ${CAIRO_LIBRARY} ${MUMPS_LIBRARY} ${MUMPS_COMPLEX_LIBRARY})
