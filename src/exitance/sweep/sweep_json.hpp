#pragma once

#include <optional>
#include <string>

#include "exitance/sweep/run_sweep.hpp"

namespace exitance {

/// JSON of a failed step, and its reader; empty if the text is damaged.
std::string failure_json(const StepFailure& failure);
std::optional<StepFailure> parse_failure(const std::string& text);

/// Parameters of a variant, and the keys of its steps.
std::string variant_json(const SweepPlan& plan, std::size_t index, const ResolvedVariant& variant);

/// `sweep PLAN --list --json`.
std::string sweep_json(const SweepPlan& plan, const std::vector<VariantState>& states);

/// `sweep PLAN --run K --json` and `--local N --json`.
std::string sweep_report_json(const SweepReport& report);

/// Text of the value at a key such as "energy.emitted" or "rooms.0.mean" of a JSON text: a number, a text, or 1 and 0
/// for true and false; empty text for null. Nothing if there is no such key, or if it is a list or an object.
std::optional<std::string> json_value(const std::string& text, const std::string& key);

}  // namespace exitance
