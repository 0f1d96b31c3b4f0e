# Writes OUTPUT, a source file that says which commit the program is built of; it is only touched when that has changed.
# In: OUTPUT, FOLDER of the sources, GIT (empty: none is installed).
set(commit "")
if(GIT)
  execute_process(COMMAND ${GIT} -C ${FOLDER} describe --always --dirty --abbrev=12 --exclude=*
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT commit MATCHES "^[0-9a-f]+(-dirty)?$")
  set(commit "unknown")
endif()
set(text "// Written by commit.cmake.\n\nnamespace astrosplat {\nextern const char* const built_commit;  // for main.cpp\nconst char* const built_commit = \"${commit}\";\n}\n")
set(before "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
