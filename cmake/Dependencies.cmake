# SPDX-License-Identifier: Apache-2.0
find_package(Threads REQUIRED)
find_package(tl-expected REQUIRED)
find_package(fmt REQUIRED)
find_package(TBB REQUIRED)
find_package(hwy REQUIRED)
find_package(OpenEXR 3 REQUIRED)
find_package(PNG REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json 3 REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(pugixml REQUIRED)
find_package(CLI11 2 REQUIRED)
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
# pocketfft is a header without a package of its own: Debian ships it in gemmi-dev.
find_path(POCKETFFT_INCLUDE_DIR gemmi/third_party/pocketfft_hdronly.h)
if(NOT POCKETFFT_INCLUDE_DIR)
  message(FATAL_ERROR "pocketfft is missing: install gemmi-dev, or set POCKETFFT_INCLUDE_DIR to the folder that has "
                      "gemmi/third_party/pocketfft_hdronly.h")
endif()
if(CONTREJOUR_TESTS)
  find_package(doctest REQUIRED)
endif()

# LEMON's network simplex is a header, too; the library itself is not linked.
find_path(LEMON_INCLUDE_DIR lemon/network_simplex.h)
if(NOT LEMON_INCLUDE_DIR)
  message(FATAL_ERROR "LEMON is missing: install liblemon-dev, or set LEMON_INCLUDE_DIR to the folder that has "
                      "lemon/network_simplex.h")
endif()
