# cmake -DSOURCE=dir -DHEADER=file -P write_commit.cmake: the commit that `dir` is at, as a header. It is written only
# when it has changed, so that nothing is compiled again for a commit that is still the same.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  set(commit "")
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define GRIDMERGE_COMMIT \"${commit}\"\n")
