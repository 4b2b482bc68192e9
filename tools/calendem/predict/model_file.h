// SPDX-License-Identifier: GPL-2.0-or-later
// model.json: a calibrated material as `calendem calibrate` writes it and `predict` and `design`
// read it. It names the bank by its files and their hashes; it does not hold it.
#ifndef CALENDEM_PREDICT_MODEL_FILE_H
#define CALENDEM_PREDICT_MODEL_FILE_H

#include "predict/prediction.h"
#include <nlohmann/json.hpp>

namespace calendem {

/// Of the bank's files; `left_out` may be empty.
nlohmann::ordered_json to_json(const FilmBank &bank, const Calibration &calibration,
                               const std::vector<LeftOut> &left_out);

/// How that case begins.
inline constexpr const char *kHeadOfCase = "# The most probable material of a calibration";

/// A case.toml of one of the materials: the middle of the draws of the most probable hypothesis.
std::string case_of(const FilmBank &bank, const Calibration &calibration, std::size_t material);

/// The bank's table beside its file, with the file's name.
std::string table_file(const std::string &bank_file);

struct Model {
  FilmBank bank;
  Calibration calibration;
  nlohmann::ordered_json json; ///< of the file
};
/// Throws Failure(2): a file that is missing, cut or no model, or a bank that has changed.
Model read_model(const std::string &file);

} // namespace calendem

#endif
