# `cpack -G DEB` in the build folder makes the Debian package of the release it runs on.
set(package_files ${PROJECT_BINARY_DIR}/debian)
set(package_mod share/freecad/Mod/BeltGrinding)  # the system's Mod folder in Debian 12 and 13
set(package_doc share/doc/beltgrinding)
set(as_deb COMPONENT deb EXCLUDE_FROM_ALL)

# The revision carries Debian's release: the same version for Debian 13 is an upgrade of Debian 12's.
cmake_host_system_information(RESULT debian QUERY DISTRIB_VERSION_ID)
set(package_revision "1~deb${debian}")
string(REGEX MATCH "<maintainer email=\"([^\"]+)\">([^<]+)<" matched "${package_xml}")
set(package_maintainer "${CMAKE_MATCH_2} <${CMAKE_MATCH_1}>")
string(REGEX MATCH "<date>([^<]+)<" matched "${package_xml}")
execute_process(COMMAND date --utc --rfc-email --date=${CMAKE_MATCH_1} OUTPUT_VARIABLE package_date
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)

foreach(file changelog copyright beltgrind postinst prerm postrm)
  configure_file(cmake/debian/${file}.in ${package_files}/${file} @ONLY
                 FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                  WORLD_READ WORLD_EXECUTE)
endforeach()
execute_process(COMMAND gzip -9nc ${package_files}/changelog OUTPUT_FILE ${package_files}/changelog.gz
                COMMAND_ERROR_IS_FATAL ANY)
# What depends on the machine belongs into /usr/lib; FreeCAD's Mod folder gets a link to it.
foreach(module ${modules})
  set(file ${module}${PYTHON_MODULE_EXTENSION})
  file(CREATE_LINK ../../../../lib/beltgrinding/${file} ${package_files}/${file} SYMBOLIC)
  install(FILES ${package_files}/${file} DESTINATION ${package_mod} ${as_deb})
endforeach()
file(CREATE_LINK ../../freecad/Mod/BeltGrinding/docs ${package_files}/manual SYMBOLIC)
# `import beltgrinding` works in the system's Python.
file(CREATE_LINK ../../../share/freecad/Mod/BeltGrinding/beltgrinding ${package_files}/beltgrinding SYMBOLIC)

install_workbench(${package_mod} ${as_deb})
install(TARGETS ${modules} beltgrinding_cad_reader LIBRARY DESTINATION lib/beltgrinding ${as_deb}
        RUNTIME DESTINATION lib/beltgrinding ${as_deb})
install(PROGRAMS ${package_files}/beltgrind DESTINATION bin ${as_deb})
install(FILES ${package_files}/beltgrinding DESTINATION lib/python3/dist-packages ${as_deb})
install(CODE "execute_process(COMMAND ${PROJECT_SOURCE_DIR}/cmake/debian/lookup.sh ${Python_EXECUTABLE} \
${PROJECT_SOURCE_DIR}/Mod/BeltGrinding ${package_files} COMMAND_ERROR_IS_FATAL ANY)" ${as_deb})
install(DIRECTORY ${package_files}/man/ DESTINATION share/man/man1 ${as_deb})
install(FILES ${package_files}/completion/bash DESTINATION share/bash-completion/completions
        RENAME beltgrind ${as_deb})
install(FILES ${package_files}/completion/zsh DESTINATION share/zsh/vendor-completions
        RENAME _beltgrind ${as_deb})
install(FILES ${package_files}/completion/fish DESTINATION share/fish/vendor_completions.d
        RENAME beltgrind.fish ${as_deb})
install(FILES ${package_files}/copyright ${package_files}/manual DESTINATION ${package_doc} ${as_deb})
install(FILES ${package_files}/changelog.gz DESTINATION ${package_doc} RENAME changelog.Debian.gz
        ${as_deb})

set(CPACK_PACKAGE_NAME beltgrinding)
set(CPACK_PACKAGE_VENDOR "")
set(CPACK_PACKAGE_CONTACT "${package_maintainer}")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulation of robotic belt grinding for FreeCAD")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "\
A robot presses a free-form metal part on an abrasive belt. This FreeCAD
workbench tells what the belt will leave and where it will cut too deep: it
follows the robot's own program pose by pose with an elastic contact wheel and
gives the deviation of the ground surface from the design at every point.
.
The command beltgrind does the same without FreeCAD's window.")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/package)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
    GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL deb)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${package_revision})
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
math(EXPR next_python "${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PACKAGE_DEPENDS "freecad, python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), \
python3 (<< ${Python_VERSION_MAJOR}.${next_python}), python3-numpy, python3-jsonschema, python3-matplotlib, \
python3-pil, libjs-three")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "calculix-ccx, weasyprint, python3-dask, python3-distributed, python3-openturns")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${package_files}/postinst ${package_files}/prerm
    ${package_files}/postrm)
include(CPack)
