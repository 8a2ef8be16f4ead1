# Parts that are built where their packages are found.

# beltgrinding_part(NAME DEFAULT TEXT): the option BELTGRINDING_NAME. AUTO: built if its packages are
# found; ON: an error if they are not; OFF: not looked for.
function(beltgrinding_part name default text)
  set(BELTGRINDING_${name} ${default} CACHE STRING "Build ${text}: ON, OFF, or AUTO (if its packages are found)")
  set_property(CACHE BELTGRINDING_${name} PROPERTY STRINGS AUTO ON OFF)
  set_property(GLOBAL PROPERTY BELTGRINDING_${name}_TEXT "${text}")
endfunction()

# beltgrinding_decide(NAME MISSING...): sets BELTGRINDING_HAS_NAME, by the option and by what is missing.
function(beltgrinding_decide name)
  set(BELTGRINDING_HAS_${name} OFF PARENT_SCOPE)
  if(NOT BELTGRINDING_${name})
    return()
  endif()
  set(missing ${ARGN})
  if(NOT missing)
    set(BELTGRINDING_HAS_${name} ON PARENT_SCOPE)
    return()
  endif()
  get_property(text GLOBAL PROPERTY BELTGRINDING_${name}_TEXT)
  list(JOIN missing ", " missing)
  if(BELTGRINDING_${name} STREQUAL "AUTO")
    message(STATUS "Not built: ${text}; missing: ${missing}")
  else()
    message(FATAL_ERROR "BELTGRINDING_${name} is ON (${text}), and these are missing: ${missing}")
  endif()
endfunction()
