// What does not change from frame to frame as long as a lens's surfaces reflect alike, a section of RenderCache:
// reflectances by wavelength, as tables for tracing and as means for planning.
// Thread-safety: from one thread at a time; what it hands out may be used from any.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/lens.h"
#include "optics/trace/by_wavelength.h"
#include "render/interface/reflected_share.h"

namespace contrejour {

class LensTables {
 public:
  // A lens as far as reflectances depend on it: glasses, coatings, and which surfaces have a rim of their own. Focus,
  // zoom, stop, iris and dirt are no part of it.
  class Key {
   public:
    Key(const LensState& lens);  // NOLINT: converts
    [[nodiscard]] const LensState& lens() const { return lens_; }
    friend bool operator==(const Key& a, const Key& b) { return a.lens_.surfaces == b.lens_.surfaces; }

   private:
    LensState lens_;
  };

  explicit LensTables(const Key& key);

  // Each table is made when it is first asked for.
  [[nodiscard]] const TablesByWavelength& tables() const { return tables_; }
  [[nodiscard]] ReflectedShares reflected(std::span<const double> lambda_nm);

  // For a new frame: forgets all once it holds more wavelengths than a few frames have. Tables that were handed out
  // stay.
  void forget_if_large();

 private:
  std::shared_ptr<const LensState> lens_;
  TablesByWavelength tables_;
  ReflectedShares reflected_;
};

}  // namespace contrejour
