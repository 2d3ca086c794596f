# Finds OpenImageIO's headers and libraries and names them OpenImageIO::OpenImageIO. OpenImageIO's own CMake package refuses
# to work where its command-line tools are not installed, which bring Qt with them on Debian and Ubuntu; Imath's, which its
# headers need, complains likewise of absent Python bindings.
find_path(OpenImageIO_INCLUDE_DIR OpenImageIO/imageio.h)
find_library(OpenImageIO_LIBRARY OpenImageIO)
find_library(OpenImageIO_UTIL_LIBRARY OpenImageIO_Util)
find_path(OpenImageIO_IMATH_INCLUDE_DIR ImathVec.h PATH_SUFFIXES Imath)
find_library(OpenImageIO_IMATH_LIBRARY NAMES Imath Imath-3_1 Imath-3_2)

set(OpenImageIO_VERSION "")
if(OpenImageIO_INCLUDE_DIR)
  file(STRINGS ${OpenImageIO_INCLUDE_DIR}/OpenImageIO/oiioversion.h lines REGEX "define OIIO_VERSION_(MAJOR|MINOR|PATCH) +[0-9]")
  string(REGEX MATCHALL "[0-9]+" numbers "${lines}")
  list(JOIN numbers "." OpenImageIO_VERSION)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenImageIO
  REQUIRED_VARS OpenImageIO_LIBRARY OpenImageIO_UTIL_LIBRARY OpenImageIO_IMATH_LIBRARY OpenImageIO_INCLUDE_DIR
    OpenImageIO_IMATH_INCLUDE_DIR
  VERSION_VAR OpenImageIO_VERSION)
mark_as_advanced(OpenImageIO_INCLUDE_DIR OpenImageIO_IMATH_INCLUDE_DIR OpenImageIO_LIBRARY OpenImageIO_UTIL_LIBRARY
  OpenImageIO_IMATH_LIBRARY)

if(OpenImageIO_FOUND AND NOT TARGET OpenImageIO::OpenImageIO)
  add_library(OpenImageIO::OpenImageIO UNKNOWN IMPORTED)
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES IMPORTED_LOCATION "${OpenImageIO_LIBRARY}")
  target_include_directories(OpenImageIO::OpenImageIO INTERFACE ${OpenImageIO_INCLUDE_DIR} ${OpenImageIO_IMATH_INCLUDE_DIR})
  target_link_libraries(OpenImageIO::OpenImageIO INTERFACE ${OpenImageIO_UTIL_LIBRARY} ${OpenImageIO_IMATH_LIBRARY})
endif()
