// SPDX-License-Identifier: GPL-2.0-or-later
#include "bond_record.h"
#include "error.h"
#include "fix.h"
#include <cmath>
#include <cstring>
#include <type_traits>

using namespace LAMMPS_NS;

void RepeatedSettings::check(const RepeatedSettings &now, Error *error, Fix *owner) const {
  const struct {
    const char *name;
    double now, before;
  } all[] = {{"contact_diameter", now.contact_diameter, contact_diameter},
             {"surface_inset", now.surface_inset, surface_inset},
             {"inset_fading", now.inset_fading, inset_fading},
             {"shrinkage", now.shrinkage, shrinkage},
             {"shrinkage's time", now.shrinkage_time, shrinkage_time}};
  for (const auto &setting : all) {
    char message[300];
    snprintf(message, sizeof message,
             "%s is %g, and the run that goes on from this restart file began with %g: it must "
             "stay as it was. Give %.10g, or begin the run anew",
             setting.name, setting.now, setting.before, setting.before);
    if (std::fabs(setting.now - setting.before) > 1e-9 * setting.before)
      error->fix_error(FLERR, owner, message);
  }
}

namespace {
const double kFormat = 3.0; // the first value; up to 1 in files of version 1.0.0
} // namespace

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
  visit(r.repeated.contact_diameter);
  visit(r.repeated.surface_inset);
  visit(r.repeated.inset_fading);
  visit(r.repeated.shrinkage);
  visit(r.repeated.shrinkage_time);
  visit(r.bodies);
  visit(r.largest_radius);
}

void BondRecord::write(FILE *fp) const {
  std::vector<double> values = {kFormat};
  BondRecord copy = *this;
  for_each_value(copy, [&values](auto &value) { values.push_back(static_cast<double>(value)); });
  values.push_back(static_cast<double>(events.size()));
  const double *all = reinterpret_cast<const double *>(events.data());
  values.insert(values.end(), all, all + events.size() * sizeof(BreakEvent) / sizeof(double));
  const int bytes = static_cast<int>(values.size() * sizeof(double));
  fwrite(&bytes, sizeof(int), 1, fp);
  fwrite(values.data(), sizeof(double), values.size(), fp);
}

void BondRecord::read(const char *buf, Error *error, Fix *owner) {
  const auto next = [&buf] {
    double value;
    memcpy(&value, buf, sizeof value);
    buf += sizeof value;
    return value;
  };
  if (next() != kFormat)
    error->fix_error(
        FLERR, owner,
        "the restart file was written by another version of the plugin, which keeps other "
        "values of the bonds. Begin the run anew, or go on with that version");
  for_each_value(*this, [&next](auto &value) {
    value = static_cast<std::remove_reference_t<decltype(value)>>(next());
  });
  events.resize(static_cast<size_t>(next()));
  for (BreakEvent &event : events) {
    memcpy(&event, buf, sizeof event);
    buf += sizeof event;
  }
}
