# Configures a project of which Ajar is a part. Installs a build into a scratch folder, builds tests/install against it and
# renders a scene with both programs.
# Usage: cmake -DBUILD=<build folder> -DSOURCE=<source tree> -DGUEST=<tests/install> -DSCENE=<file> -DSCRATCH=<folder> -DGENERATOR=<name>
#              -DCOMPILER=<c++> -DFLAGS=<compiler flags> -P run.cmake
cmake_minimum_required(VERSION 3.22)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${code}): ${command}\n${said}")
  endif()
  message(NOTICE "${said}")
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
run(${CMAKE_COMMAND} -S ${GUEST}/part -B ${SCRATCH}/part -G ${GENERATOR} -DAJAR=${SOURCE} -DCMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix)
run(${CMAKE_COMMAND} -S ${GUEST} -B ${SCRATCH}/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix
    -DDOCUMENTS=${SCRATCH}/prefix/share/doc/ajar
    -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS}" "-DCMAKE_EXE_LINKER_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/guest ${SCENE} ${SCRATCH}/guest.exr)
foreach(document README library)
  file(MAKE_DIRECTORY ${SCRATCH}/${document})
  file(CREATE_LINK ${SOURCE}/scenes ${SCRATCH}/${document}/scenes SYMBOLIC)
  run(${CMAKE_COMMAND} -E chdir ${SCRATCH}/${document} ${SCRATCH}/build/${document})
endforeach()
run(${SCRATCH}/prefix/bin/ajar render ${SCENE} -o ${SCRATCH}/ajar.exr --spp 4 --quiet)
run(${SCRATCH}/prefix/bin/ajar compare ${SCRATCH}/guest.exr ${SCRATCH}/ajar.exr)
file(REMOVE_RECURSE ${SCRATCH})
