# `cmake --install` puts the workbench where FreeCAD finds it: the Mod folder of whoever configures.
# Three more layouts are components, installed only by name: `addon`, the same in any folder; `portable`, which
# tools/package gives the modules for several Pythons; `deb`, what the Debian package holds
# (BeltGrindingPackage.cmake).
if(NOT DEFINED CACHE{BELTGRINDING_MOD_DIR})
  set(mod_dir "${CMAKE_INSTALL_DATADIR}/freecad/Mod")
  find_program(FREECADCMD_PROGRAM NAMES freecadcmd FreeCADCmd)
  if(FREECADCMD_PROGRAM)
    execute_process(COMMAND ${FREECADCMD_PROGRAM} ${PROJECT_SOURCE_DIR}/cmake/print_mod_folder.py
                    INPUT_FILE /dev/null OUTPUT_VARIABLE printed ERROR_QUIET TIMEOUT 60)
    if(printed MATCHES "Mod folder: ([^\n]+)")
      set(mod_dir "${CMAKE_MATCH_1}")
    endif()
  endif()
  set(BELTGRINDING_MOD_DIR "${mod_dir}/BeltGrinding" CACHE PATH "Where the workbench is installed")
endif()

# Installed, the workbench lies beside package.xml; in the checkout it does not.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS package.xml)
file(READ package.xml package_xml)
string(REPLACE "./Mod/BeltGrinding/" "./" package_xml "${package_xml}")
string(REPLACE "../../Resources" "Resources" package_xml "${package_xml}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/package.xml CONTENT "${package_xml}" @ONLY)

set(modules beltgrinding_core)
foreach(optional beltgrinding_coin beltgrinding_scan)
  if(TARGET ${optional})
    list(APPEND modules ${optional})
  endif()
endforeach()
add_custom_target(beltgrinding_modules DEPENDS ${modules} beltgrinding_cad_reader translations)  # all that an installation needs built

# Beside each core stands what it was built for, so that one that does not fit can say why before it
# is loaded: beltgrinding/engine/library.py.
cmake_host_system_information(RESULT system QUERY DISTRIB_PRETTY_NAME)
file(GENERATE OUTPUT $<TARGET_FILE:beltgrinding_core>.json CONTENT
     "{\"system\": \"${system}\", \"python\": \"${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}\", \
\"opencascade\": \"${OpenCASCADE_VERSION}\"}\n")

# install_workbench(FOLDER [COMPONENT name EXCLUDE_FROM_ALL]): all but the compiled modules.
function(install_workbench folder)
  install(DIRECTORY Mod/BeltGrinding/ DESTINATION ${folder} ${ARGN}
          PATTERN "__pycache__" EXCLUDE PATTERN "*.so" EXCLUDE)
  install(DIRECTORY Resources docs DESTINATION ${folder} ${ARGN})
  install(FILES ${compiled_translations} DESTINATION ${folder}/Resources/translations ${ARGN})
  install(FILES ${PROJECT_BINARY_DIR}/package.xml README.md CONTRIBUTING.md CHANGELOG.md
          $<TARGET_FILE:beltgrinding_core>.json DESTINATION ${folder} ${ARGN})
endfunction()

install_workbench(${BELTGRINDING_MOD_DIR})
install(FILES LICENSE DESTINATION ${BELTGRINDING_MOD_DIR})
install(TARGETS ${modules} beltgrinding_cad_reader LIBRARY DESTINATION ${BELTGRINDING_MOD_DIR}
        RUNTIME DESTINATION ${BELTGRINDING_MOD_DIR})

foreach(layout addon portable)
  set(by_name COMPONENT ${layout} EXCLUDE_FROM_ALL)
  install_workbench(. ${by_name})
  install(FILES LICENSE DESTINATION . ${by_name})
  install(TARGETS beltgrinding_cad_reader RUNTIME DESTINATION . ${by_name})
endforeach()
install(TARGETS ${modules} LIBRARY DESTINATION . COMPONENT addon EXCLUDE_FROM_ALL)
