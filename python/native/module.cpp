// SPDX-License-Identifier: Apache-2.0
// The module contrejour._native: the library's functions as the package's Python files (python/contrejour) call them.
// It takes and returns plain values, tuples, dictionaries and arrays; names, defaults and documentation are theirs.
#include "native/errors.h"
#include "native/long_call.h"
#include "native/objects.h"

PYBIND11_MODULE(_native, module) {
  using namespace contrejour::python;
  add_errors();
  module.attr("version") = CONTREJOUR_VERSION;
  add_long_calls(module);
  add_settings(module);
  add_lenses(module);
  add_optics(module);
  add_measured(module);
  add_rays(module);
  add_polynomials(module);
  add_direct_polynomials(module);
  add_rendering(module);
  add_pictures(module);
}
