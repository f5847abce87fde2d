#include "render/interface/wavelength_tables.h"

#include <vector>

#include "base/tasks.h"

namespace contrejour {

TablesByWavelength tables_for(const LensState& lens, std::span<const double> lambda_nm, const Context& context) {
  TablesByWavelength tables;
  for (const double lambda : lambda_nm) tables.try_emplace(lambda);
  std::vector<TablesByWavelength::value_type*> entries;
  for (auto& entry : tables) entries.push_back(&entry);
  Context quiet = context;
  quiet.progress = {};
  parallel_for(entries.size(), quiet, [&](std::size_t k) {
    entries[k]->second = std::make_shared<const ReflectanceTables>(lens, entries[k]->first);
  });
  return tables;
}

}  // namespace contrejour
