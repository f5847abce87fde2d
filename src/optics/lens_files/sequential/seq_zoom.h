// SPDX-License-Identifier: Apache-2.0
// ZOO commands of a CODE V file: positions of a zoom, if only thicknesses change.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "optics/lens_files/sequential/seq_commands.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {

// The index of the word among the first two that is a position, such as Z2; the number of words if none is.
[[nodiscard]] std::size_t seq_zoom_word(const SeqCommand& command);

class SeqZoom {
 public:
  // Reads ZOO 3 or ZOO THI S5 1 2 3. Returns a problem, or nothing.
  [[nodiscard]] std::optional<std::string> add(const SeqCommand& command);
  // Reads THI S5 Z2 7, for the one position that words[word] names.
  void add_one(const SeqCommand& command, std::size_t word);

  // All positions; empty without a zoom, or if more than thicknesses change: a warning then says that position 1 is
  // read.
  [[nodiscard]] std::vector<DesignPosition> positions(const SequentialDesign& design,
                                                      std::vector<std::string>& warnings) const;

 private:
  struct Row {
    int line = 0;
    std::string name;
    std::vector<double> values;
  };
  std::size_t count_ = 0;
  std::map<int, Row> thicknesses_;  // by surface, kSeqImage for the image
  std::vector<Row> others_;
  std::map<std::size_t, double> nominal_mm_;  // of positions whose title states it
};

}  // namespace contrejour::inline internal
