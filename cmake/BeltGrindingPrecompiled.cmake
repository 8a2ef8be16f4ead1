# beltgrinding_precompile(TARGET GROUP HEADERS...): parses the headers once for all targets of a GROUP, which
# are compiled with the same flags; half of a clean build would be reading Eigen, pybind11 and GoogleTest.
#
# Only speed: each file still includes what it uses, since inside another project nothing is precompiled, and
# clang-tidy, which cannot read what GCC has precompiled, is run without.
function(beltgrinding_precompile target group)
  get_target_property(type ${target} TYPE)
  if(NOT BELTGRINDING_PRECOMPILE OR type STREQUAL "INTERFACE_LIBRARY")
    return()
  endif()
  # Where a compiler will not take it, that is no fault: it reads the headers.
  set_target_properties(${target} PROPERTIES PCH_WARN_INVALID OFF)
  get_property(first GLOBAL PROPERTY BELTGRINDING_PRECOMPILED_${group})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
    set_property(GLOBAL PROPERTY BELTGRINDING_PRECOMPILED_${group} ${target})
  endif()
endfunction()
