# Installs BUILD into SCRATCH, then configures, builds and runs CONSUMER against what was installed; then builds PLUGIN
# against it, and lets the installed program load that.
set(prefix ${SCRATCH}/prefix)
set(consumer_build ${SCRATCH}/build)
file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH})

function(step)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${SCRATCH} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
step(${CMAKE_COMMAND} -S ${CONSUMER} -B ${consumer_build} -DCMAKE_PREFIX_PATH=${prefix}
     -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
step(${CMAKE_COMMAND} --build ${consumer_build})
step(${consumer_build}/consumer)
step(${prefix}/bin/gridmerge --help)

step(${CMAKE_COMMAND} -S ${PLUGIN} -B ${SCRATCH}/plugin -DCMAKE_PREFIX_PATH=${prefix}
     -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
step(${CMAKE_COMMAND} --build ${SCRATCH}/plugin)
step(${prefix}/bin/gridmerge methods centroid --plugin ${SCRATCH}/plugin/libcentroid.so)
