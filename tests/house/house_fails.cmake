# Shows that house.cmake sees every breach it looks for: builds small trees with one breach each.
# Usage: cmake -DHOUSE=<house.cmake> -DSCRATCH=<folder> -P house_fails.cmake
cmake_minimum_required(VERSION 3.22)

set(opening "// Enters: nothing.\n// Leaves: nothing.\n")

# run(RESULT OUTPUT FILE TEXT): the verdict on a sound tree to which FILE was added.
function(run result output file text)
  file(REMOVE_RECURSE ${SCRATCH})
  file(WRITE ${SCRATCH}/include/ajar/core/vec.h "${opening}struct Vec {\n};\n")
  file(WRITE ${SCRATCH}/include/ajar/render/render.h "${opening}#include \"ajar/core/vec.h\"\n")
  file(WRITE ${SCRATCH}/src/accel/accel.cpp "#include <embree3/rtcore.h>\n#include \"ajar/core/vec.h\"\n")
  file(WRITE ${SCRATCH}/${file} "${text}")
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${SCRATCH} -P ${HOUSE} RESULT_VARIABLE code OUTPUT_VARIABLE said
                  ERROR_VARIABLE said)
  set(${result} ${code} PARENT_SCOPE)
  set(${output} "${said}" PARENT_SCOPE)
endfunction()

function(expect_breach words file text)
  run(code said ${file} "${text}")
  if(code EQUAL 0 OR NOT "${said}" MATCHES "${words}")
    message(FATAL_ERROR "${file} should be found: \"${words}\"; house.cmake said (exit ${code}):\n${said}")
  endif()
endfunction()

run(code said src/core/fine.cpp "#include \"ajar/core/vec.h\"\n#include <vector>\nint a[2];\n")
if(NOT code EQUAL 0)
  message(FATAL_ERROR "a sound tree was refused:\n${said}")
endif()

string(REPEAT "int line_;\n" 501 long_text)
expect_breach("render lies to its right" src/core/bad.cpp "#include \"ajar/render/render.h\"\n")
expect_breach("render lies to its right" include/ajar/core/bad.h "${opening}#  include <ajar/render/render.h>\n")
expect_breach("there is no room attic" src/app/bad.cpp "#include \"ajar/attic/box.h\"\n")
expect_breach("not in include" src/app/bad.cpp "#include \"ajar/core/gone.h\"\n")
expect_breach("climbing" src/app/bad.cpp "#include \"../render/job.h\"\n")
expect_breach("private to render" src/app/bad.cpp "#include \"render/job.h\"\n")
expect_breach("only src/accel" src/render/bad.cpp "#include <embree3/rtcore.h>\n")
expect_breach("loops go through" src/film/bad.cpp "#include <tbb/parallel_for.h>\n")
expect_breach("does not open" include/ajar/core/bad.h "#pragma once\n// Enters: x\n// Leaves: y\n")
expect_breach("not a room" src/cellar/bad.cpp "int a;\n")
expect_breach("holds" src/core/bad.cpp "int seed() { return std::rand(); }\n")
expect_breach("type Vec is in include/ajar/core/vec.h too" src/film/bad.h "${opening}struct alignas(8) Vec final {\n};\n")
expect_breach("folder of one machine" docs/bad.md "see /home/somebody/ajar\n")
expect_breach("501 lines" src/core/bad.cpp "${long_text}")
file(REMOVE_RECURSE ${SCRATCH})
message(NOTICE "house.cmake finds every breach")
