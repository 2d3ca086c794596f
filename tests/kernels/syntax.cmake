# Compiles every kernel file with clang, in both precisions, warnings as errors: what a run-time compiler may let pass.
# CLANG, ROOT
file(GLOB files ${ROOT}/kernels/*/*.cl)
set(failed 0)
foreach(file ${files})
  set(flags -Wall -Wextra -Werror)
  file(STRINGS ${file} kernels REGEX "^kernel void")
  if(NOT kernels)
    list(APPEND flags -Wno-unused-function)  # included by others
  endif()
  foreach(precision "" -DVITRAIL_SINGLE -DVITRAIL_NO_INT64_ATOMICS -DVITRAIL_TRIANGLES)
    execute_process(COMMAND ${CLANG} -x cl -cl-std=CL1.2 -Xclang -finclude-default-header ${flags} ${precision} -fsyntax-only
      -I${ROOT}/kernels -I${ROOT}/include/vitrail ${file} RESULT_VARIABLE result ERROR_VARIABLE text)
    if(result)
      message("${file} ${precision}:\n${text}")
      math(EXPR failed "${failed} + 1")
    endif()
  endforeach()
endforeach()
list(LENGTH files count)
if(failed OR count EQUAL 0)
  message(FATAL_ERROR "${failed} of ${count} kernel files, in four variants each, do not compile cleanly")
endif()
message("${count} kernel files compile cleanly in four variants")
