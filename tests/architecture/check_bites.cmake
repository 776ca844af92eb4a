# SPDX-License-Identifier: MIT
# cmake -D FOLDER=<scratch folder> -P check_bites.cmake: check.cmake accepts a small clean tree, and names each of the
# violations planted in it, and nothing else.

cmake_minimum_required(VERSION 3.25)

set(spdx "// SPDX-License-Identifier: MIT\n")
set(ROOT ${FOLDER}/tree)

function(run_check)
  execute_process(COMMAND ${CMAKE_COMMAND} -D ROOT=${ROOT} -P ${CMAKE_CURRENT_LIST_DIR}/check.cmake
    RESULT_VARIABLE status ERROR_VARIABLE errors)
  string(REGEX MATCHALL "[a-z_/]+\\.[ch]pp(:[0-9]+)?: [^\n]*" complaints "${errors}")
  set(status ${status} PARENT_SCOPE)
  set(complaints "${complaints}" PARENT_SCOPE)
endfunction()

function(expect_complaints)
  run_check()
  list(SORT complaints)
  list(SORT ARGN)
  if(NOT complaints STREQUAL "${ARGN}")
    list(JOIN complaints "\n  " found)
    list(JOIN ARGN "\n  " expected)
    message(SEND_ERROR "found:\n  ${found}\nexpected:\n  ${expected}")
  endif()
  if((ARGC EQUAL 0 AND NOT status EQUAL 0) OR (ARGC GREATER 0 AND status EQUAL 0))
    message(SEND_ERROR "exit status ${status} with ${ARGC} violations")
  endif()
endfunction()

file(REMOVE_RECURSE ${FOLDER})
file(WRITE ${ROOT}/CMakeLists.txt "sphstab_module(model\n  SOURCES one.cpp two.cpp)\nadd_executable(x cli/main.cpp)\n")
file(WRITE ${ROOT}/tests/CMakeLists.txt "sphstab_tests(model SOURCES test_one.cpp)\n")
file(WRITE ${ROOT}/model/one.cpp "${spdx}#include \"model/one.hpp\"\n#include <vector>\n#include <fmt/format.h>\n")
file(WRITE ${ROOT}/model/two.cpp "${spdx}int a[] = {1};\n")
file(WRITE ${ROOT}/cli/main.cpp "${spdx}#include \"study/one.hpp\"\n")
file(WRITE ${ROOT}/study/one.hpp "${spdx}#include \"solver/one.hpp\"\n#include \"analysis/one.hpp\"\n")
file(WRITE ${ROOT}/tests/model/test_one.cpp "${spdx}#include \"solver/one.hpp\"\n")
expect_complaints()

file(WRITE ${ROOT}/model/one.cpp "${spdx}\n#include \"io/toml.hpp\"\n")
file(WRITE ${ROOT}/analysis/one.hpp "${spdx}int a[] = {1}; // [;\n\n#include \"solver/one.hpp\"\n# include <solver/one.hpp>\n")
file(WRITE ${ROOT}/solver/one.hpp "${spdx}#include \"../analysis/one.hpp\"\n#include \"model/one.hpp\"\n")
file(WRITE ${ROOT}/io/one.hpp "#pragma once\n#include \"study/one.hpp\"\n")
file(WRITE ${ROOT}/study/one.cpp "${spdx}")
file(WRITE ${ROOT}/cli/main.cpp "${spdx}// TODO\n#include \"analysis/one.hpp\"\n")
file(WRITE ${ROOT}/tests/model/test_two.cpp "")
expect_complaints(
  "model/one.cpp:3: model may not include io"
  "analysis/one.hpp:4: analysis may not include solver"
  "analysis/one.hpp:5: analysis may not include solver"
  "solver/one.hpp:2: solver may not include .."
  "io/one.hpp:1: the first line is not the SPDX line"
  "io/one.hpp:2: io may not include study"
  "study/one.cpp: not listed in CMakeLists.txt"
  "cli/main.cpp:2: TODO"
  "cli/main.cpp:3: cli may not include analysis"
  "tests/model/test_two.cpp:1: the first line is not the SPDX line"
  "tests/model/test_two.cpp: not listed in tests/CMakeLists.txt")
