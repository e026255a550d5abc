# Writes OUTPUT, which says the commit that SOURCE is at, where that is not what it says already.
# Usage: cmake -DSOURCE=DIR -DOUTPUT=FILE -P commit.cmake
execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=10 --dirty=\ with\ changes
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR NOT commit)
  set(commit "unknown: built without its history")
endif()
set(text "#define SLOSH_COMMIT \"${commit}\"\n")
set(before "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
