// SPDX-License-Identifier: GPL-2.0-or-later
// Where a gap lies at a glance: observables over conditions.
#ifndef CALENDEM_DIAGNOSE_COMPARE_GAP_PAGE_H
#define CALENDEM_DIAGNOSE_COMPARE_GAP_PAGE_H

#include <nlohmann/json.hpp>
#include <string>

namespace calendem {

/// For a page: {"conditions": [""], "rows": [{"observable", "cells": [{"text", "colour"}]}]} of
/// rows "where" of gap.json, whose residual is simulation less experiment in "unit" and whose z
/// is beyond `threshold`. Conditions in the order of `conditions`, the others by name.
nlohmann::json heat_map(const nlohmann::json &where, double threshold,
                        const std::vector<std::string> &conditions = {});

/// A JSON number in that format; a dash where it is none.
std::string shown(const nlohmann::json &number, const char *format);

/// A unit of gap.json as a reader writes it.
std::string shown_unit(const std::string &unit);

} // namespace calendem

#endif
