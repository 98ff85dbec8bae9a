# Installs the libraries of `build` into `prefix`, which is emptied first.
file(REMOVE_RECURSE ${prefix})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${build} --prefix ${prefix} --component development
                COMMAND_ERROR_IS_FATAL ANY)
