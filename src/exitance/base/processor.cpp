#include "exitance/base/processor.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "exitance/base/processor_check.hpp"

namespace exitance {
namespace {

// names in the order of Processor
constexpr std::array<std::string_view, 3> processor_names = {"any", "avx2", "avx512"};

/// Value of EXITANCE_PROCESSOR; empty if it is not set.
std::string_view asked_processor() {
    const char* const value = std::getenv("EXITANCE_PROCESSOR");
    return value == nullptr ? std::string_view{} : std::string_view(value);
}

Processor widest_processor() {
#ifdef EXITANCE_HAS_WIDE_KERNELS
    constexpr unsigned middle = avx2 | fma;
    const unsigned sets = sets_of_processor();
    if ((sets & middle) == middle) return (sets & avx512) != 0 ? Processor::avx512 : Processor::avx2;
#endif
    return Processor::any;
}

Processor chosen_processor() {
    const auto* const name = std::ranges::find(processor_names, asked_processor());
    const Processor asked =
        name == processor_names.end() ? Processor::fastest : static_cast<Processor>(name - processor_names.begin());
    return std::min(asked, widest_processor());
}

}  // namespace

Processor this_processor() {
    static const Processor chosen = chosen_processor();
    return chosen;
}

std::optional<Error> processor_error() {
    const std::string_view asked = asked_processor();
    if (asked.empty() || std::ranges::find(processor_names, asked) != processor_names.end()) return std::nullopt;
    return Error{ErrorCode::usage, fmt::format("there is no instruction set '{}'", asked), "EXITANCE_PROCESSOR",
                 "any, avx2 or avx512"};
}

}  // namespace exitance
