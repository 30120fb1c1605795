# How Ajar is compiled, and ajar_room, which makes a library of a room.
include(CheckLinkerFlag)

add_library(ajar_options INTERFACE)
target_compile_features(ajar_options INTERFACE cxx_std_20)
target_compile_options(ajar_options INTERFACE -Wall -Wextra -Wshadow -Wpedantic -Wno-missing-field-initializers
                       -fno-math-errno -fno-trapping-math)
if(AJAR_NATIVE)
  target_compile_options(ajar_options INTERFACE -march=native)
endif()
if(AJAR_WERROR)
  target_compile_options(ajar_options INTERFACE -Werror)
endif()
if(AJAR_SANITIZE)
  target_compile_options(ajar_options INTERFACE -fsanitize=${AJAR_SANITIZE} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all)
  target_link_options(ajar_options INTERFACE -fsanitize=${AJAR_SANITIZE})
endif()
if(AJAR_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "AJAR_FUZZ needs clang: CXX=clang++ cmake --preset fuzz")
  endif()
  target_compile_options(ajar_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(AJAR_LTO)
  include(CheckIPOSupported)
  check_ipo_supported()
  set(CMAKE_INTERPROCEDURAL_OPTIMIZATION ON)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # else the installed libraries are for this compiler's own optimiser alone
    list(TRANSFORM CMAKE_CXX_COMPILE_OPTIONS_IPO REPLACE "-fno-fat-lto-objects" "-ffat-lto-objects")
  endif()
endif()

# gold links in a tenth of the time, and there are sixty programs. Of clang's sanitizers it warns by the thousand. For
# Ajar's own programs: whoever links its libraries chooses a linker for himself.
check_linker_flag(CXX -fuse-ld=gold AJAR_GOLD)
if(AJAR_GOLD AND NOT AJAR_LTO AND NOT AJAR_SANITIZE)
  add_link_options(-fuse-ld=gold)
endif()

# With AJAR_AT_ONCE, headers of others that most files of TARGET read are compiled once. None of Ajar's own: a change of
# one compiles what includes it and no more.
function(ajar_precompile target)
  if(AJAR_AT_ONCE)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()
# The same that SOURCE has.
function(ajar_precompile_from source target)
  if(AJAR_AT_ONCE)
    target_precompile_headers(${target} REUSE_FROM ${source})
  endif()
endfunction()

# With AJAR_AT_ONCE, files of TARGET are compiled COUNT at a time: for those that do little but read large headers of others.
function(ajar_join_files target count)
  if(AJAR_AT_ONCE)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${count})
  endif()
endfunction()

# ajar_room(NAME FILES... USES ROOMS...): one static library per room, so that link order is the data flow; USES names the
# rooms to its left.
function(ajar_room name)
  cmake_parse_arguments(ROOM "" "" "FILES;USES" ${ARGN})
  add_library(ajar_${name} STATIC ${ROOM_FILES})
  add_library(ajar::${name} ALIAS ajar_${name})
  set_target_properties(ajar_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  set_property(GLOBAL APPEND PROPERTY AJAR_ROOMS ajar_${name})
  target_include_directories(ajar_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                             $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(ajar_${name} PRIVATE $<BUILD_INTERFACE:ajar_options> fmt::fmt)
  target_compile_features(ajar_${name} PUBLIC cxx_std_20)
  if(name STREQUAL core)
    ajar_precompile(ajar_core <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional> <span>
                    <string> <vector> <fmt/format.h> <glm/glm.hpp>)
  else()
    ajar_precompile_from(ajar_core ajar_${name})
  endif()
  foreach(use ${ROOM_USES})
    target_link_libraries(ajar_${name} PUBLIC ajar_${use})
  endforeach()
endfunction()
