# SPDX-License-Identifier: Apache-2.0
# Warnings, sanitizers, and the tools that make a build quick where they are present.
if(MSVC)
  add_compile_options(/W4 /permissive- /utf-8)
else()
  add_compile_options(-Wall -Wextra -Wshadow -Wnon-virtual-dtor)
  # The reference must give the same numbers everywhere: no contraction into fused multiply-adds
  # unless a packet kernel asks for one by name.
  add_compile_options(-ffp-contract=off)
endif()

# Files that are compiled as one (JumboBuild.cmake) see each other's unnamed namespaces. A function in one of these hides
# a function of the same name in a header, and could convert a double to an integer silently.
if(PROJECT_IS_TOP_LEVEL AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Werror=float-conversion)
endif()

if(CONTREJOUR_SANITIZE)
  add_compile_options(-fsanitize=${CONTREJOUR_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # What these look for ends in accesses that AddressSanitizer reports; they double the time packet kernels compile.
  add_compile_options(-fno-sanitize=null,alignment,object-size,pointer-overflow)
  add_link_options(-fsanitize=${CONTREJOUR_SANITIZE})
  add_compile_definitions(CONTREJOUR_SANITIZED)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()
find_program(MOLD_PROGRAM mold)
if(MOLD_PROGRAM AND NOT MSVC)
  add_link_options(-fuse-ld=mold)
endif()
