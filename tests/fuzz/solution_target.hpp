#pragma once

#include <string>
#include <vector>

namespace exitance::fuzz {

/// Solutions as they are written, small ones.
std::vector<std::string> solution_corpus();

/// Loads a solution, and if it is one, asks for light and means of it.
void read_solution_bytes(const std::string& bytes);

/// Checksums of the metadata as they would be, had it been written so: what stands behind them is reached.
void mend_solution(std::string& bytes);

/// A solution whose container is whole, but not what it holds: the bytes say which values become what.
std::vector<std::string> value_corpus();
void read_solution_with_values(const std::string& script);

/// The same in two steps (Target::rehearse): what the library reads in a copy of the process, here, and the rest.
bool rehearse_solution_bytes(const std::string& bytes);
bool rehearse_solution_with_values(const std::string& script);
void read_rehearsed_solution();

}  // namespace exitance::fuzz
