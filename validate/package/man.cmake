# Writes a man page, compressed, of the command or of one of its subcommands. Called with -D HELP2MAN, DETP, COMMAND (may be empty), VERSION,
# MORE (sections of the page that --help does not have) and PAGE (the file without .gz).
set(subject "${DETP} ${COMMAND}")
string(STRIP "${subject}" subject)
string(REGEX REPLACE "-$" "" name "detp-${COMMAND}")
separate_arguments(words UNIX_COMMAND "${subject} --help all")
execute_process(COMMAND ${words} OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCH "^[^\n]*" title "${help}")
string(REGEX REPLACE "\\.$" "" title "${title}")
execute_process(COMMAND ${HELP2MAN} --no-info --help-option "--help all" --include ${MORE} --name "${title}" --version-string "detp ${VERSION}" ${subject}
                OUTPUT_VARIABLE page COMMAND_ERROR_IS_FATAL ANY)
string(TOUPPER "${name}" upper)
string(REGEX REPLACE "\n\\.TH DETP " "\n.TH ${upper} " page "${page}")
string(REGEX REPLACE "\ndetp \\\\- " "\n${name} \\\\- " page "${page}")
file(WRITE ${PAGE} "${page}")
execute_process(COMMAND gzip -9nf ${PAGE} COMMAND_ERROR_IS_FATAL ANY)
