# beltgrinding_room(NAME [ROOMS ...] [PRIVATE_ROOMS ...] [PACKAGES ...] [PRIVATE_PACKAGES ...]
#                   [PRIVATE_INCLUDES ...])
#
# One folder of src/ is one room, the static library bg_NAME. Its headers lie in three places:
#   include/beltgrinding/x.h   "beltgrinding/x.h": the library's, installed
#   internal/NAME/x.h          "NAME/x.h": for the rooms that declare this one
#   x.h                        "x.h": private, beside the sources
# A room is given only its own include folders and those of the rooms it declares: ROOMS, which its
# own headers show (and which are handed on), and PRIVATE_ROOMS, which its sources alone include. So an
# include that is not declared does not compile. PACKAGES and PRIVATE_PACKAGES are targets from outside.
#
# What is declared is written to <build>/rooms.json (beltgrinding_write_rooms); tests/house/test_rooms.py
# compares it with the includes and with the table in docs/architecture.md.
function(beltgrinding_room name)
  cmake_parse_arguments(ARG "" ""
    "ROOMS;PRIVATE_ROOMS;PACKAGES;PRIVATE_PACKAGES;PRIVATE_INCLUDES" ${ARGN})
  # Static, nothing of the library shows in what it is linked into; shared, all of it does.
  set(visibility hidden)
  set(hidden_inlines ON)
  if(BUILD_SHARED_LIBS)
    set(visibility default)
    set(hidden_inlines OFF)
  endif()
  set(folders)
  foreach(folder include internal)
    if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/${folder})
      list(APPEND folders ${CMAKE_CURRENT_SOURCE_DIR}/${folder})
    endif()
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  if(sources)
    add_library(bg_${name} STATIC ${sources})
    target_include_directories(bg_${name} PUBLIC ${folders})
    target_include_directories(bg_${name} SYSTEM PRIVATE ${ARG_PRIVATE_INCLUDES})
    target_compile_features(bg_${name} PUBLIC cxx_std_20)
    set_target_properties(bg_${name} PROPERTIES
      CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON VISIBILITY_INLINES_HIDDEN ${hidden_inlines}
      CXX_VISIBILITY_PRESET ${visibility} BELTGRINDING_PACKAGES "${ARG_PRIVATE_PACKAGES}")
    target_link_libraries(bg_${name} PUBLIC ${ARG_PACKAGES} PRIVATE ${ARG_PRIVATE_PACKAGES} bg_warnings)
    foreach(room IN LISTS ARG_ROOMS)
      target_link_libraries(bg_${name} PUBLIC bg_${room})
    endforeach()
    foreach(room IN LISTS ARG_PRIVATE_ROOMS)
      target_link_libraries(bg_${name} PRIVATE bg_${room})
    endforeach()
  else()
    add_library(bg_${name} INTERFACE)
    target_include_directories(bg_${name} INTERFACE ${folders})
    target_link_libraries(bg_${name} INTERFACE ${ARG_PACKAGES})
    foreach(room IN LISTS ARG_ROOMS)
      target_link_libraries(bg_${name} INTERFACE bg_${room})
    endforeach()
  endif()
  beltgrinding_record_room(${name} ROOMS ${ARG_ROOMS} PRIVATE_ROOMS ${ARG_PRIVATE_ROOMS})
endfunction()

# beltgrinding_record_room(NAME [ROOMS ...] [PRIVATE_ROOMS ...]): for rooms that are no static library.
function(beltgrinding_record_room name)
  cmake_parse_arguments(ARG "" "" "ROOMS;PRIVATE_ROOMS" ${ARGN})
  foreach(list ROOMS PRIVATE_ROOMS)
    list(JOIN ARG_${list} "\", \"" ${list})
    string(REPLACE "\"\"" "" ${list} "\"${${list}}\"")
  endforeach()
  set_property(GLOBAL APPEND PROPERTY BELTGRINDING_ROOMS
    "  \"${name}\": {\"rooms\": [${ROOMS}], \"private_rooms\": [${PRIVATE_ROOMS}]}")
endfunction()

# beltgrinding_reads_cad_files(TARGET): a program of this build, tests and benchmarks, that finds the
# build's reader of CAD files; BELTGRINDING_CAD_READER in the environment goes before.
function(beltgrinding_reads_cad_files target)
  target_sources(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests/core/cad_reader_here.cpp)
  target_compile_definitions(${target} PRIVATE
    BELTGRINDING_CAD_READER_HERE="$<TARGET_FILE:beltgrinding_cad_reader>")
  add_dependencies(${target} beltgrinding_cad_reader)
endfunction()

# Writes what all rooms have declared, in their order.
function(beltgrinding_write_rooms)
  get_property(rooms GLOBAL PROPERTY BELTGRINDING_ROOMS)
  list(JOIN rooms ",\n" rooms)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/rooms.json CONTENT "{\n@rooms@\n}\n" @ONLY)
endfunction()
