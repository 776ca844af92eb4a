# SPDX-License-Identifier: MIT

# Flags of everything that is ours. Comparable results on every machine: no fused multiply-adds, no fast math.
# g++ 12 takes literal + std::string for overlapping memory (GCC bug 105651), hence no -Wrestrict.
# clang's -Wconversion would count the signs of indices too, which g++'s leaves alone.
add_library(sphstab_flags INTERFACE)
target_compile_options(sphstab_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wswitch-enum -Wnon-virtual-dtor -Wold-style-cast
  -ffp-contract=off
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<BOOL:${SPHSTAB_WARNINGS_AS_ERRORS}>:-Werror>)
target_include_directories(sphstab_flags INTERFACE ${PROJECT_SOURCE_DIR})

# sphstab_module(<folder> SOURCES <files in the folder> LINK <targets>)
function(sphstab_module folder)
  cmake_parse_arguments(MODULE "" "" "SOURCES;LINK" ${ARGN})
  list(TRANSFORM MODULE_SOURCES PREPEND ${folder}/)
  add_library(sphstab_${folder} STATIC ${MODULE_SOURCES})
  target_link_libraries(sphstab_${folder} PUBLIC sphstab_flags ${MODULE_LINK})
endfunction()
