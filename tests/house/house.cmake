# The house rules that a compiler does not check. Usage: cmake -DROOT=<source tree> -P house.cmake
# A room includes only itself and the rooms to its left; Embree stays in accel, TBB in one file of core; every header says what
# enters and what leaves; files stay short; a few words stay out.
cmake_minimum_required(VERSION 3.22)

set(rooms core scene accel field path join film render report app)
set(long 450)     # lines of a file: worth a note
set(longest 500)  # refused
# Words: shared state, hidden order and noise that no seed repeats, and folders of somebody's machine.
set(banned_in_code "using namespace [a-z]" "std::rand\\(" "random_device" "mt19937" "TODO" "FIXME" "XXX" "-ffast-math")
set(banned_everywhere "[ \"'(=]/(work|tmp|home|root)/[a-z]")

# The first folder or file of every path that the repository holds.
set(top_level .ci .clang-format .gitignore CMakeLists.txt CMakePresets.json LICENSE README.md benchmarks check cmake demo docs
    include scenes src tests)

set(breaches 0)
macro(breach what)
  math(EXPR breaches "${breaches} + 1")
  message(NOTICE "${what}")
endmacro()

function(line_count text out)
  string(REGEX REPLACE "[^\n]" "" newlines "${text}")
  string(LENGTH "${newlines}" count)
  set(${out} ${count} PARENT_SCOPE)
endfunction()

# The room that a file belongs to: include/ajar/ROOM/..., src/ROOM/...
function(room_of file out)
  string(REGEX REPLACE "^(include/ajar|src)/([a-z]+)/.*$" "\\2" room "${file}")
  set(${out} ${room} PARENT_SCOPE)
endfunction()

macro(check_include file room included)
  if("${included}" MATCHES "^ajar/([a-z]+)/")
    set(other ${CMAKE_MATCH_1})
    list(FIND rooms ${room} here)
    list(FIND rooms ${other} there)
    if(there EQUAL -1)
      breach("${file}: includes ${included}, but there is no room ${other}")
    elseif(there GREATER here)
      breach("${file}: ${room} includes ${included}, but ${other} lies to its right")
    elseif(NOT EXISTS ${ROOT}/include/${included})
      breach("${file}: includes ${included}, which is not in include/")
    endif()
  elseif("${included}" MATCHES "\\.\\.")
    breach("${file}: includes ${included}: name the room (ajar/ROOM/...) instead of climbing out of it")
  elseif("${included}" MATCHES "^(core|scene|accel|field|path|join|film|render|report|app)/" AND NOT CMAKE_MATCH_1 STREQUAL ${room})
    breach("${file}: includes ${included}, which is private to ${CMAKE_MATCH_1}")
  endif()
  if("${included}" MATCHES "embree" AND NOT ("${file}" MATCHES "^src/accel/"))
    breach("${file}: includes ${included}; only src/accel may know the ray tracer")
  endif()
  if("${included}" MATCHES "^(tbb|oneapi)/" AND NOT "${file}" STREQUAL "src/core/parallel.cpp")
    breach("${file}: includes ${included}; loops go through ajar/core/parallel.h, where the thread sanitizer follows them")
  endif()
endmacro()

file(GLOB_RECURSE code RELATIVE ${ROOT} ${ROOT}/include/ajar/*.h ${ROOT}/src/*.h ${ROOT}/src/*.cpp)
list(LENGTH code code_count)
if(code_count EQUAL 0)
  message(FATAL_ERROR "no source files under ${ROOT}: nothing was checked")
endif()
foreach(file ${code})
  room_of(${file} room)
  if(NOT room IN_LIST rooms)
    breach("${file}: ${room} is not a room of the house (${rooms})")
    continue()
  endif()
  file(STRINGS ${ROOT}/${file} includes REGEX "^[ \t]*#[ \t]*include")
  foreach(line ${includes})
    if("${line}" MATCHES "[<\"]([^>\"]+)[>\"]")
      check_include(${file} ${room} ${CMAKE_MATCH_1})
    endif()
  endforeach()
  file(READ ${ROOT}/${file} text)
  if(file MATCHES "\\.h$" AND NOT "${text}" MATCHES "^// Enters: [^\n]+\n(//[^\n]+\n)*// Leaves: ")
    breach("${file}: does not open with its lines \"// Enters: ...\" and \"// Leaves: ...\"")
  endif()
  foreach(word ${banned_in_code})
    if("${text}" MATCHES "${word}")
      breach("${file}: holds \"${CMAKE_MATCH_0}\"")
    endif()
  endforeach()
endforeach()

# One name, one type: of two that share a name the linker keeps the functions of one, whatever the other looks like. What
# begins a line is of namespace ajar; what a file has for itself stands in a namespace without a name.
file(GLOB_RECURSE headers RELATIVE ${ROOT} ${ROOT}/include/ajar/*.h ${ROOT}/src/*.h ${ROOT}/tests/render/*.h)
foreach(file ${headers})
  file(STRINGS ${ROOT}/${file} lines REGEX "^(struct|class|enum class) [^;]*{")
  foreach(line ${lines})
    string(REGEX REPLACE "^(struct|class|enum class) (alignas\\([^)]*\\) )?([A-Za-z]+).*$" "\\3" type "${line}")
    if(DEFINED type_${type} AND NOT type_${type} STREQUAL file)
      breach("${file}: type ${type} is in ${type_${type}} too; name one of them otherwise")
    endif()
    set(type_${type} ${file})
  endforeach()
endforeach()

# What a file has for itself, by another's name.
file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/src/*.cpp)
execute_process(COMMAND awk -f ${CMAKE_CURRENT_LIST_DIR}/names.awk ${sources} WORKING_DIRECTORY ${ROOT}
                OUTPUT_VARIABLE shared RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE)
if(shared OR failed)
  breach("${shared}; name one of them otherwise (awk: ${failed})")
endif()

file(GLOB_RECURSE all RELATIVE ${ROOT} ${ROOT}/include/*.h ${ROOT}/src/*.* ${ROOT}/tests/*.h ${ROOT}/tests/*.cpp
     ${ROOT}/benchmarks/*.* ${ROOT}/docs/*.md ${ROOT}/scenes/*.py ${ROOT}/scenes/*.xml ${ROOT}/*.md)
foreach(file ${all})
  file(READ ${ROOT}/${file} text)
  foreach(word ${banned_everywhere})
    if("${text}" MATCHES "${word}")
      breach("${file}: names a folder of one machine: ${CMAKE_MATCH_0}...")
    endif()
  endforeach()
  line_count("${text}" lines)
  if(lines GREATER longest AND file MATCHES "\\.(h|cpp|py)$")
    breach("${file}: ${lines} lines; divide it")
  elseif(lines GREATER long AND file MATCHES "\\.(h|cpp|py)$")
    message(NOTICE "note: ${file} has ${lines} lines: soon to be divided")
  endif()
endforeach()

# What a program wrote where it was run is not to be committed with the rest. A tree without its history is not asked.
if(EXISTS ${ROOT}/.git)
  execute_process(COMMAND git -C ${ROOT} -c core.quotePath=false ls-files -z COMMAND cut -z -d/ -f1 COMMAND sort -zu
                  COMMAND tr "\\0" ";" OUTPUT_VARIABLE held)
  foreach(entry ${held})
    if(NOT entry IN_LIST top_level)
      breach("${entry}: the repository does not hold this at its top; take it out, or name it in house.cmake")
    endif()
  endforeach()
endif()

if(breaches GREATER 0)
  message(FATAL_ERROR "${breaches} breach(es) of the house rules in ${code_count} files")
endif()
message(NOTICE "${code_count} files keep the house rules")
