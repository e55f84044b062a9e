# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the header TO, the commit of the tree SOURCE, where it says another one so far.  Of an export without git it is that of HILO_COMMIT.
set(commit "$ENV{HILO_COMMIT}")
if(NOT commit)
  execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=10 --dirty=+ --exclude=* OUTPUT_VARIABLE commit
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT commit)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${TO} CONTENT "#define HILO_COMMIT \"${commit}\"\n")
