#pragma once

#include <string>
#include <utility>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/sweep/input_hashes.hpp"
#include "exitance/sweep/sweep_plan.hpp"

namespace exitance {

/// A step of one variant.
struct ResolvedStep {
    std::string name;
    /// Hash of everything that the result depends on: the program's version, the command, the content of its input
    /// files, and the keys of the steps whose results it reads. Steps of equal keys have equal results.
    std::string key;
    /// Command with its own files written as "{dir}/X"; empty for files from templates.
    std::vector<std::string> words;
    std::vector<std::string> outputs;  ///< Paths of the files that the step writes, relative to {dir}.
    std::vector<int> accepted;
    std::vector<HashedFile> inputs;  ///< Files that the step reads, except those that earlier steps write.
    std::vector<std::pair<std::string, std::string>> texts;  ///< Path below {dir} and content of files from templates.
};

/// The steps of a variant in their order, and where the values to collect are.
struct ResolvedVariant {
    std::vector<ResolvedStep> steps;
    std::vector<std::size_t> output_steps;  ///< Per output of the plan: index of the step that writes its file.
};

/// Fills in the placeholders of all steps of variant `index` (from 0), connects the steps, and hashes their inputs. A
/// path "{dir}/X" that an earlier step makes becomes a path in that step's folder, FOLDER/steps/KEY/X.
/// Errors: bad_input, with the line of the plan; cannot_read.
Result<ResolvedVariant> resolve_variant(const SweepPlan& plan, std::size_t index, InputHashes& hashes);

/// Folder of the finished steps of a plan.
std::string step_folder(const SweepPlan& plan);

}  // namespace exitance
