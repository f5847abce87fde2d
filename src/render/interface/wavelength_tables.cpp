#include "render/interface/wavelength_tables.h"

#include <vector>

#include "base/tasks.h"

namespace contrejour {

TablesByWavelength tables_for(const FramePlan& plan, const LensState& lens, const Context& context) {
  TablesByWavelength tables;
  for (const PlannedLight& light : plan.lights) {
    for (const PlannedPass& pass : light.passes) tables.try_emplace(pass.lambda_nm);
  }
  std::vector<TablesByWavelength::value_type*> entries;
  for (auto& entry : tables) entries.push_back(&entry);
  Context quiet = context;
  quiet.progress = {};
  parallel_for(entries.size(), quiet, [&](std::size_t k) {
    entries[k]->second = std::make_unique<ReflectanceTables>(lens, entries[k]->first);
  });
  return tables;
}

}  // namespace contrejour
