# cmake -DHOW=installed|folder -DBUILD=build tree -DSCRATCH=folder -DGENERATOR=.. -DCOMPILER=.. -DFLAGS=..
#   [-DPROGRAM=bin/vitrail] -P check.cmake
# Builds and runs the outside project beside this file against Vitrail as `cmake --install` lays it down, or builds it with
# Vitrail as a folder of its own. The scratch folder is emptied first, so that nothing of an earlier layout can help.
get_filename_component(here ${CMAKE_SCRIPT_MODE_FILE} DIRECTORY)
get_filename_component(source ${here}/../.. ABSOLUTE)
file(REMOVE_RECURSE ${SCRATCH})

function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(result)
    list(JOIN ARGN " " line)
    message("${line}\n${output}")
    message(FATAL_ERROR "ended with ${result}")
  endif()
endfunction()

if(HOW STREQUAL installed)
  step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix --component core)
  set(where -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix)
else()
  set(where -DVITRAIL_SOURCE=${source})
endif()
# Without optimisation: only whether it compiles, links and runs is asked.
step(${CMAKE_COMMAND} -S ${here} -B ${SCRATCH}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Debug
  "-DCMAKE_CXX_FLAGS_DEBUG=${FLAGS} -O0" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF ${where})
if(HOW STREQUAL installed)
  step(${CMAKE_COMMAND} --build ${SCRATCH}/build --target hello)
  step(${SCRATCH}/build/hello)
  # The program finds its modules where they are installed.
  if(PROGRAM)
    step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix --component program)
    step(${SCRATCH}/prefix/${PROGRAM} shape torus -o ${SCRATCH}/mesh.ply)
    step(${SCRATCH}/prefix/${PROGRAM} render ${SCRATCH}/mesh.ply --effect voxels -r 16 --size 40x30 -o ${SCRATCH}/out.png)
  endif()
else()
  # One part and the program's own file say whether Vitrail compiles inside another project; the rest of the library, a
  # minute's work, would say it again.
  step(${CMAKE_COMMAND} --build ${SCRATCH}/build --target vitrail_core hello_object)
endif()
file(REMOVE_RECURSE ${SCRATCH})
