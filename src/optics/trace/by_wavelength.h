// SPDX-License-Identifier: Apache-2.0
// Tables and trace steps of a lens at single wavelengths, each made at its first use: rays are traced at few
// wavelengths, and polynomials interpolate the others (wavelength_samples.h).
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "optics/trace/lens_steps.h"
#include "optics/trace/packet_trace.h"

namespace contrejour::inline internal {

// One T for each wavelength, made by the first thread that needs it and kept. Copies share them.
template <class T>
class ByWavelength {
 public:
  using Make = std::function<T(double lambda_nm)>;

  ByWavelength() = default;  // to be assigned
  explicit ByWavelength(Make make) : shared_(std::make_shared<Shared>(std::move(make))) {}

  [[nodiscard]] const T& at(double lambda_nm) const {
    Entry& entry = shared_->entry(lambda_nm);
    std::call_once(entry.once, [&] { entry.value.emplace(shared_->make(lambda_nm)); });
    return *entry.value;
  }

  [[nodiscard]] std::size_t size() const { return shared_ ? shared_->size() : 0; }
  // The sum over those that are made; while none is being made.
  [[nodiscard]] std::size_t bytes() const
    requires requires(const T& made) { made.bytes(); }
  {
    return shared_ ? shared_->bytes() : 0;
  }

 private:
  struct Entry {
    std::once_flag once;
    std::optional<T> value;
  };
  struct Shared {
    Make make;
    std::mutex mutex;
    std::map<double, Entry> entries;

    explicit Shared(Make make_one) : make(std::move(make_one)) {}
    Entry& entry(double lambda_nm) {
      const std::scoped_lock lock(mutex);
      return entries[lambda_nm];
    }
    [[nodiscard]] std::size_t size() {
      const std::scoped_lock lock(mutex);
      return entries.size();
    }
    [[nodiscard]] std::size_t bytes() {
      const std::scoped_lock lock(mutex);
      std::size_t sum = 0;
      for (const auto& [lambda_nm, entry] : entries) sum += entry.value ? entry.value->bytes() : 0;
      return sum;
    }
  };

  std::shared_ptr<Shared> shared_;
};

class TablesByWavelength : public ByWavelength<ReflectanceTables> {
 public:
  TablesByWavelength() = default;  // to be assigned
  // The lens must outlive them.
  explicit TablesByWavelength(const LensState& lens)
      : ByWavelength([&lens](double lambda_nm) { return ReflectanceTables(lens, lambda_nm); }) {}
  explicit TablesByWavelength(std::shared_ptr<const LensState> lens)
      : ByWavelength([lens = std::move(lens)](double lambda_nm) { return ReflectanceTables(*lens, lambda_nm); }) {}
};

// The lens must outlive them.
class StepsByWavelength : public ByWavelength<LensSteps> {
 public:
  StepsByWavelength(const LensState& lens, const TablesByWavelength& tables)
      : ByWavelength([&lens, tables](double lambda_nm) { return LensSteps(lens, tables.at(lambda_nm)); }), lens_(lens) {
  }

  [[nodiscard]] const LensState& lens() const { return lens_; }

 private:
  const LensState& lens_;
};

}  // namespace contrejour::inline internal
