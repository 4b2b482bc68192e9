// SPDX-License-Identifier: GPL-2.0-or-later
// Seals: hashes that commit to a text without revealing it.
#ifndef CALENDEM_TESTS_VALIDATION_SEALED_SEALING_H
#define CALENDEM_TESTS_VALIDATION_SEALED_SEALING_H

#include "base/provenance.h"
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace calendem {

/// Hash of the files of a folder (no folders in it), by name and bytes, in the order of their
/// names. Throws Failure(2) for anything that is no plain file: a link may lead elsewhere.
std::string sha256_of_files(const std::string &folder);

/// True if a case hands out folders before and after, beside which nothing may lie (Failure(2));
/// false if it hands out files.
bool is_intervention(const std::string &folder);
std::string sha256_of_case(const std::string &folder);

/// Folders of a case's samples alone: 0, 1, ... with the cause, each beside K_without.
std::vector<std::string> samples_in(const std::string &folder);
std::string sha256_of_samples(const std::string &folder);

/// Throws Failure(4) if a hash is not the one that was written down.
void must_be(const std::string &is, const std::string &should, const std::string &what);

/// A JSON object. Throws Failure(2) if the file holds none.
nlohmann::json json_of(const std::string &file);

/// The bytes of a file. Throws Failure(2) if it cannot be read.
std::string bytes_of(const std::string &file);

/// 32 bytes of the system's random device as hex digits. Throws Failure(2) if there is none.
std::string random_secret();

/// What is derived from a secret for one purpose: 64 hex digits, or a seed.
std::string derived(const std::string &secret, const std::string &purpose);
std::uint64_t derived_seed(const std::string &secret, const std::string &purpose);

/// SHA-256 of the salt, a line's end and the truth as JSON with sorted keys and no spaces.
std::string commitment(const std::string &salt, const nlohmann::json &truth);

} // namespace calendem

#endif
