# Finds what Ajar stands on. Read by Ajar's own build and, installed beside ajarConfig.cmake, by projects that link Ajar.
include(CMakeFindDependencyMacro)

macro(ajar_find)
  if(CMAKE_FIND_PACKAGE_NAME)
    find_dependency(${ARGN})
  else()
    find_package(${ARGN} REQUIRED)
  endif()
endmacro()

ajar_find(Threads)
ajar_find(TBB)
ajar_find(glm)
ajar_find(embree 3)
ajar_find(Imath)
ajar_find(fmt)
ajar_find(pugixml)
ajar_find(nlohmann_json)
ajar_find(ZLIB)

# Embree 3's package leaves variables; a target exports better than a path.
if(NOT TARGET ajar::embree)
  add_library(ajar::embree INTERFACE IMPORTED)
  target_include_directories(ajar::embree SYSTEM INTERFACE ${EMBREE_INCLUDE_DIRS})
  target_link_libraries(ajar::embree INTERFACE ${EMBREE_LIBRARIES})
endif()

# OpenImageIO is found by hand: Debian's package file for CMake demands its viewer (and Qt) and OpenCV's headers, which
# nothing here needs.
find_path(AJAR_OIIO_INCLUDE OpenImageIO/imageio.h)
find_library(AJAR_OIIO_LIBRARY OpenImageIO)
find_library(AJAR_OIIO_UTIL_LIBRARY OpenImageIO_Util)
mark_as_advanced(AJAR_OIIO_INCLUDE AJAR_OIIO_LIBRARY AJAR_OIIO_UTIL_LIBRARY)
if(NOT AJAR_OIIO_INCLUDE OR NOT AJAR_OIIO_LIBRARY OR NOT AJAR_OIIO_UTIL_LIBRARY)
  message(FATAL_ERROR "OpenImageIO is missing (Debian: libopenimageio-dev); elsewhere set CMAKE_PREFIX_PATH to its folder")
endif()
if(NOT TARGET ajar::openimageio)
  add_library(ajar::openimageio INTERFACE IMPORTED)
  target_include_directories(ajar::openimageio SYSTEM INTERFACE ${AJAR_OIIO_INCLUDE})
  target_link_libraries(ajar::openimageio INTERFACE ${AJAR_OIIO_LIBRARY} ${AJAR_OIIO_UTIL_LIBRARY} Imath::Imath)
endif()
