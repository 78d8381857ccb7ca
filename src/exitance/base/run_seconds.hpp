#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace exitance {

/// Parts of a run whose time is recorded, in the order of reports. `visibility` and `form_factors` are parts of
/// `solve`, `total` is the time of the whole run.
enum class RunPart : std::uint8_t {
    total,
    read,
    mesh,
    direct,
    link,
    visibility,
    form_factors,
    solve,
    gather,
    certify,
    reconstruct,
    light_groups,
    mix,
    write
};

/// Seconds of every part of a run; 0 for a part that was not timed.
class RunSeconds {
  public:
    /// Names of the parts in files and JSON.
    static constexpr std::array names{"total",       "read",         "mesh",  "direct", "link",
                                      "visibility",  "form_factors", "solve", "gather", "certify",
                                      "reconstruct", "light_groups", "mix",   "write"};

    double& operator[](RunPart part) { return seconds_[static_cast<std::size_t>(part)]; }
    double operator[](RunPart part) const { return seconds_[static_cast<std::size_t>(part)]; }
    friend bool operator==(const RunSeconds&, const RunSeconds&) = default;

    /// Calls visit(part) for every part, in order.
    template <class Visit>
    static void for_parts(const Visit& visit) {
        for (std::size_t i = 0; i < names.size(); ++i) visit(static_cast<RunPart>(i));
    }
    static const char* name(RunPart part) { return names[static_cast<std::size_t>(part)]; }

  private:
    std::array<double, names.size()> seconds_{};
};

}  // namespace exitance
