# beltgrinding_room(NAME [DEPENDS ...] [PRIVATE_DEPENDS ...] [PRIVATE_INCLUDES ...])
#
# One folder of src/ is one static library target bg_NAME. DEPENDS are what its public headers
# need; PRIVATE_DEPENDS stay inside its .cpp files. Includes are written from src/:
# #include "heightfield/height_field.h".
function(beltgrinding_room name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PRIVATE_DEPENDS;PRIVATE_INCLUDES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  if(sources)
    add_library(bg_${name} STATIC ${sources})
    target_include_directories(bg_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
    target_include_directories(bg_${name} SYSTEM PRIVATE ${ARG_PRIVATE_INCLUDES})
    target_link_libraries(bg_${name} PUBLIC ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE_DEPENDS}
                          bg_warnings)
  else()
    add_library(bg_${name} INTERFACE)
    target_include_directories(bg_${name} INTERFACE ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(bg_${name} INTERFACE ${ARG_DEPENDS})
  endif()
endfunction()
