#pragma once

#include <string>
#include <vector>

namespace exitance::fuzz {

/// Small valid solution files.
std::vector<std::string> solution_corpus();

/// Loads a solution and, if it is valid, evaluates light and mean values.
void read_solution_bytes(const std::string& bytes);

/// Corrects the checksums of the metadata, so that reading continues beyond them.
void mend_solution(std::string& bytes);

/// A corpus of scripts; the bytes of a script define which values in a valid solution file are replaced.
std::vector<std::string> value_corpus();
void read_solution_with_values(const std::string& script);

/// Two steps for the same (see Target::rehearse): first the reading that otherwise happens in a copy of the process,
/// then the rest.
bool rehearse_solution_bytes(const std::string& bytes);
bool rehearse_solution_with_values(const std::string& script);
void read_rehearsed_solution();

}  // namespace exitance::fuzz
