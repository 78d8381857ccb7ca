#pragma once

#include <optional>
#include <string>

#include "exitance/sweep/run_sweep.hpp"

namespace exitance {

/// JSON of a failed step, and its reader; empty if the text is damaged.
std::string failure_json(const StepFailure& failure);
std::optional<StepFailure> parse_failure(const std::string& text);

/// Record of a variant in its folder: the file of the plan, the parameters, and the keys of the steps.
std::string variant_json(const SweepPlan& plan, std::size_t index, const ResolvedVariant& variant);
/// Parts of the record of a variant, by which its folder is recognised.
struct VariantRecord {
    std::size_t number = 0;  ///< From 1.
    std::string plan;        ///< Name of the plan's file; empty if the record has none.
};
/// Parses the record of a variant; empty if the text is none.
std::optional<VariantRecord> parse_variant(const std::string& text);

/// Returns the output of `sweep PLAN --list --json`.
std::string sweep_json(const SweepPlan& plan, const std::vector<VariantState>& states);

/// `sweep PLAN --run K --json` and `--local N --json`.
std::string sweep_report_json(const SweepReport& report);

/// Text of the value at a key such as "energy.emitted" or "rooms.0.mean" of a JSON text: a number, a text, or 1 and 0
/// for true and false; empty text for null. Nothing if there is no such key, or if it is a list or an object.
std::optional<std::string> json_value(const std::string& text, const std::string& key);

}  // namespace exitance
