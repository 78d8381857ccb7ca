#include "exitance/processes/result_of_all.hpp"

#include <string>
#include <vector>

#include "exitance/processes/exchange_archived.hpp"

namespace exitance {
namespace {

/// The outcome of a step in one process.
struct Outcome {
    bool failed = false;
    Error error;
};

}  // namespace

Result<void> result_of_all(Result<void> own) {
    if (processes() == 1) return own;
    std::vector<Outcome> outcomes(processes());
    if (!own) outcomes[own_process()] = {true, own.error()};
    exchange_archived(
        std::span(outcomes), 1,
        [](auto& archive, Outcome& outcome) {
            Error& error = outcome.error;
            archive(outcome.failed, error.code, error.message, error.where, error.hint);
        },
        "agreement");
    for (const Outcome& outcome : outcomes)
        if (outcome.failed) return outcome.error;
    return {};
}

}  // namespace exitance
