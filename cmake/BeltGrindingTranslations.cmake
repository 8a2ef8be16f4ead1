# The translations, compiled to <build>/translations. Qt 5's and 6's lrelease write what either reads.
find_program(LRELEASE_PROGRAM NAMES lrelease lrelease-qt5 lrelease-qt6
             HINTS /usr/lib/qt5/bin /usr/lib/qt6/bin)
set(compiled_translations)
if(LRELEASE_PROGRAM)
  file(GLOB translations CONFIGURE_DEPENDS Resources/translations/*.ts)
  foreach(source IN LISTS translations)
    cmake_path(GET source STEM stem)
    set(compiled ${PROJECT_BINARY_DIR}/translations/${stem}.qm)
    add_custom_command(OUTPUT ${compiled} DEPENDS ${source} VERBATIM
                       COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/translations
                       COMMAND ${LRELEASE_PROGRAM} -silent ${source} -qm ${compiled})
    list(APPEND compiled_translations ${compiled})
  endforeach()
else()
  message(WARNING "lrelease (qttools5-dev-tools) is missing: the workbench will speak English only")
endif()
add_custom_target(translations ALL DEPENDS ${compiled_translations})
