// SPDX-License-Identifier: GPL-2.0-or-later
#include "bond_record.h"
#include <cstring>

using namespace LAMMPS_NS;

// In the order of the file, where all are doubles.
template <class Visit> void BondRecord::for_each_value(BondRecord &r, Visit visit) {
  visit(r.created);
  visit(r.made);
  for (bigint &n : r.totals.of_mode)
    visit(n);
  visit(r.totals.energy);
  for (bigint &n : r.totals.of_bridges)
    visit(n);
  visit(r.totals.bridge_energy);
  for (bigint &n : r.bridges_made)
    visit(n);
  visit(r.shrunk);
  for (double &setting : r.repeated)
    visit(setting);
  visit(r.bodies);
  visit(r.largest_radius);
}

void BondRecord::write(FILE *fp) const {
  std::vector<double> values;
  BondRecord copy = *this;
  for_each_value(copy, [&values](auto &value) { values.push_back(static_cast<double>(value)); });
  values.push_back(static_cast<double>(events.size()));
  const double *all = reinterpret_cast<const double *>(events.data());
  values.insert(values.end(), all, all + events.size() * sizeof(BreakEvent) / sizeof(double));
  const int bytes = static_cast<int>(values.size() * sizeof(double));
  fwrite(&bytes, sizeof(int), 1, fp);
  fwrite(values.data(), sizeof(double), values.size(), fp);
}

void BondRecord::read(const char *buf) {
  const auto next = [&buf] {
    double value;
    memcpy(&value, buf, sizeof value);
    buf += sizeof value;
    return value;
  };
  for_each_value(*this, [&next](auto &value) {
    value = static_cast<std::remove_reference_t<decltype(value)>>(next());
  });
  events.resize(static_cast<size_t>(next()));
  memcpy(events.data(), buf, events.size() * sizeof(BreakEvent));
}
