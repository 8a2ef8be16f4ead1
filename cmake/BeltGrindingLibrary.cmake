# The library: libbeltgrinding (beltgrinding::core) and, where built, beltgrinding::brep, ::stock and
# ::scan. Static, or shared with BUILD_SHARED_LIBS. `cmake --install <build> --component library`
# installs it with its headers, CMake's package and pkg-config's file.
include(CMakePackageConfigHelpers)

set(library_headers ${CMAKE_INSTALL_INCLUDEDIR})
set(library_cmake ${CMAKE_INSTALL_LIBDIR}/cmake/BeltGrinding)
# With the workbench, whose install is a user's, the library is installed only by its name.
set(as_library COMPONENT library)
if(BELTGRINDING_HAS_WORKBENCH)
  list(APPEND as_library EXCLUDE_FROM_ALL)
endif()

# beltgrinding_library(NAME ROOMS ... [PUBLIC ...] [PRIVATE ...]): the rooms' objects as
# beltgrinding::NAME, with the packages that its headers show and those behind them.
function(beltgrinding_library name)
  cmake_parse_arguments(ARG "" "" "ROOMS;PUBLIC;PRIVATE" ${ARGN})
  set(target bg_library_${name})
  set(objects)
  set(headers)
  set(folders)
  foreach(room IN LISTS ARG_ROOMS)
    get_target_property(type bg_${room} TYPE)
    if(NOT type STREQUAL "INTERFACE_LIBRARY")
      list(APPEND objects $<TARGET_OBJECTS:bg_${room}>)
    endif()
    set(folder ${PROJECT_SOURCE_DIR}/src/${room}/include)
    if(IS_DIRECTORY ${folder})
      list(APPEND folders $<BUILD_INTERFACE:${folder}>)
      file(GLOB found CONFIGURE_DEPENDS ${folder}/beltgrinding/*.h)
      list(APPEND headers ${found})
    endif()
  endforeach()
  add_library(${target} ${objects})
  add_library(beltgrinding::${name} ALIAS ${target})
  target_include_directories(${target} PUBLIC ${folders} $<INSTALL_INTERFACE:${library_headers}>)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  target_compile_features(${target} PUBLIC cxx_std_20)
  set(file beltgrinding_${name})
  if(name STREQUAL core)
    set(file beltgrinding)
  endif()
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} OUTPUT_NAME ${file}
    LINKER_LANGUAGE CXX POSITION_INDEPENDENT_CODE ON VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  if(BELTGRINDING_INSTALL)
    install(TARGETS ${target} EXPORT BeltGrinding-${name}
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} ${as_library}
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${as_library}
            RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} ${as_library})
    install(FILES ${headers} DESTINATION ${library_headers}/beltgrinding ${as_library})
    install(EXPORT BeltGrinding-${name} NAMESPACE beltgrinding:: DESTINATION ${library_cmake}
            ${as_library})
  endif()
endfunction()

beltgrinding_library(core
  ROOMS base foreign mesh heightfield contact elastic surrogate gap belt models removal toolpath events heat
        engine recorders checkpoints simulation inspection
  PUBLIC Eigen3::Eigen TBB::tbb PRIVATE hdf5::hdf5 ${CMAKE_DL_LIBS})
if(BELTGRINDING_HAS_BREP)
  get_target_property(toolkits bg_brep BELTGRINDING_PACKAGES)
  beltgrinding_library(brep ROOMS brep PUBLIC beltgrinding::core PRIVATE ${toolkits})
endif()
if(BELTGRINDING_HAS_STOCK)
  beltgrinding_library(stock ROOMS meshio rays stock thickness
    PUBLIC beltgrinding::core PRIVATE embree)
endif()
# What reads foreign files finds the program for it, here or installed in any prefix.
if(TARGET beltgrinding_cad_reader)
  set(reader ${CMAKE_INSTALL_LIBEXECDIR}/beltgrinding/beltgrinding-cad-reader)
  foreach(part brep stock)
    if(TARGET bg_library_${part})
      target_sources(bg_library_${part} INTERFACE
        $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/cmake/installed_reader.cpp>
        $<INSTALL_INTERFACE:$<INSTALL_PREFIX>/${library_cmake}/installed_reader.cpp>)
      target_compile_definitions(bg_library_${part} INTERFACE
        $<BUILD_INTERFACE:BELTGRINDING_INSTALLED_READER="$<TARGET_FILE:beltgrinding_cad_reader>">
        $<INSTALL_INTERFACE:BELTGRINDING_INSTALLED_READER="$<INSTALL_PREFIX>/${reader}">)
    endif()
  endforeach()
  if(BELTGRINDING_INSTALL)
    install(PROGRAMS $<TARGET_FILE:beltgrinding_cad_reader> RENAME beltgrinding-cad-reader
            DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/beltgrinding ${as_library})
    install(FILES cmake/installed_reader.cpp DESTINATION ${library_cmake} ${as_library})
  endif()
endif()
if(BELTGRINDING_HAS_SCAN)
  get_target_property(packages bg_scan BELTGRINDING_PACKAGES)
  beltgrinding_library(scan ROOMS scan PUBLIC beltgrinding::core PRIVATE ${packages})
endif()

if(BELTGRINDING_INSTALL)
  configure_package_config_file(cmake/BeltGrindingConfig.cmake.in
    ${PROJECT_BINARY_DIR}/BeltGrindingConfig.cmake INSTALL_DESTINATION ${library_cmake}
    NO_SET_AND_CHECK_MACRO)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/BeltGrindingConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)  # before 1.0 every minor version may change the interface
  install(FILES ${PROJECT_BINARY_DIR}/BeltGrindingConfig.cmake
                ${PROJECT_BINARY_DIR}/BeltGrindingConfigVersion.cmake
          DESTINATION ${library_cmake} ${as_library})

  # HDF5 has several builds in Debian, each with a file of its own for pkg-config: the one found here.
  set(pc_hdf5)
  foreach(item IN LISTS HDF5_C_LIBRARIES)
    if(IS_ABSOLUTE ${item})
      string(APPEND pc_hdf5 " ${item}")
    else()
      string(APPEND pc_hdf5 " -l${item}")
    endif()
  endforeach()
  file(RELATIVE_PATH pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(cmake/beltgrinding.pc.in ${PROJECT_BINARY_DIR}/beltgrinding.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/beltgrinding.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig ${as_library})
endif()
