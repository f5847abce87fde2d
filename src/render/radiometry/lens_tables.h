// SPDX-License-Identifier: Apache-2.0
// A lens's reflectances by wavelength, as tables for tracing and as means for planning: a section of RenderCache, valid
// from frame to frame as long as the surfaces reflect the same.
// Thread-safety: from one thread at a time; the tables that it returns may be used from any.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/lens.h"
#include "optics/trace/by_wavelength.h"
#include "render/radiometry/ghost_reflectances.h"

namespace contrejour::inline internal {

class LensTables {
 public:
  // The properties of a lens that reflectances depend on: glasses, coatings, and which surfaces have a rim of their
  // own. They do not depend on focus, zoom, stop, iris and dirt.
  class Key {
   public:
    Key(const LensState& lens);  // NOLINT: converts
    [[nodiscard]] const LensState& lens() const { return lens_; }
    friend bool operator==(const Key& a, const Key& b) { return a.lens_.surfaces == b.lens_.surfaces; }

   private:
    LensState lens_;
  };

  explicit LensTables(const Key& key);

  // Each table is made on first use.
  [[nodiscard]] const TablesByWavelength& tables() const { return tables_; }
  [[nodiscard]] GhostReflectances reflectances(std::span<const double> lambda_nm);

  // Clears the tables if they hold more wavelengths than a few frames have. Tables that were handed out stay valid.
  void next_frame();
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  std::shared_ptr<const LensState> lens_;
  TablesByWavelength tables_;
  GhostReflectances reflectances_;
};

}  // namespace contrejour::inline internal
