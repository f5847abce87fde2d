// The ringing of one iris, kept: diffraction patterns that frames share as long as their iris is the same.
// Hand one object to render() in RingingOptions::patterns, frame after frame; a render with another iris makes it anew.
// Without one, every render makes its own. Thread-safety: renders that share an object take turns in making patterns.
// docs/physics/diffraction.md.
#pragma once

#include <cstddef>
#include <memory>

namespace contrejour {

class RingingPatterns {
 public:
  RingingPatterns();
  ~RingingPatterns();
  RingingPatterns(const RingingPatterns&) = delete;
  RingingPatterns& operator=(const RingingPatterns&) = delete;

  [[nodiscard]] std::size_t count() const;  // of pictures of the stop plane; edges' fringes take next to nothing

  struct Contents;
  [[nodiscard]] Contents& contents() const { return *contents_; }

 private:
  std::unique_ptr<Contents> contents_;
};

}  // namespace contrejour
