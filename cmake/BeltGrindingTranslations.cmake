# The window's texts in other languages, which stand with all others in Resources/messages, compiled for Qt to
# <build>/translations. Qt 5's and 6's lrelease write what either reads.
find_program(LRELEASE_PROGRAM NAMES lrelease lrelease-qt5 lrelease-qt6
             HINTS /usr/lib/qt5/bin /usr/lib/qt6/bin)
set(compiled_translations)
if(LRELEASE_PROGRAM)
  set(maker ${PROJECT_SOURCE_DIR}/cmake/window_catalogue.py)
  set(folder ${PROJECT_BINARY_DIR}/translations)
  file(GLOB languages CONFIGURE_DEPENDS Resources/messages/*.json)
  foreach(source IN LISTS languages)
    cmake_path(GET source STEM language)
    set(compiled ${folder}/BeltGrinding_${language}.qm)
    set(made ${folder}/BeltGrinding_${language}.ts)
    add_custom_command(OUTPUT ${compiled} BYPRODUCTS ${made} DEPENDS ${source} ${maker} VERBATIM
                       COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
                       COMMAND ${Python_EXECUTABLE} ${maker} ${source} ${made}
                       COMMAND ${LRELEASE_PROGRAM} -silent ${made} -qm ${compiled})
    list(APPEND compiled_translations ${compiled})
  endforeach()
else()
  message(WARNING "lrelease (qttools5-dev-tools) is missing: the workbench will speak English only")
endif()
add_custom_target(translations ALL DEPENDS ${compiled_translations})
