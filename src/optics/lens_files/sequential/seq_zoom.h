// ZOO commands of a CODE V file: positions of a zoom, if thicknesses are all that moves.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "optics/lens_files/sequential/seq_commands.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour {

// Which of the command's first two words is a position, such as Z2; beyond them if none is.
[[nodiscard]] std::size_t seq_zoom_word(const SeqCommand& command);

class SeqZoom {
 public:
  // ZOO 3; ZOO THI S5 1 2 3. What is wrong, or nothing.
  [[nodiscard]] std::optional<std::string> add(const SeqCommand& command);
  // THI S5 Z2 7: of one position, which words[word] names.
  void add_one(const SeqCommand& command, std::size_t word);

  // Each position; empty without a zoom, or where more than thicknesses changes: a
  // warning says then that position 1 is read.
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
  std::map<std::size_t, double> nominal_mm_;  // of positions that are called by it
};

}  // namespace contrejour
