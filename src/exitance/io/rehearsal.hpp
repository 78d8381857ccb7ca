#pragma once

#include <functional>
#include <optional>
#include <string>

namespace exitance {

/// Runs `work` in a copy of this process that is thrown away: what it breaks is broken there. For libraries that trust
/// files more than we do: what they survive in rehearsal they survive here, given the same bytes. The copy has one
/// thread, so that `work` must not wait for others.
/// seconds  of processor time that it may take, at least
/// returns  how it failed ("crashes", "takes more than 2 s"), or nothing when `work` returned. Where no process can be
///          made there is no rehearsal.
std::optional<std::string> rehearse(const std::function<void()>& work, double seconds);

}  // namespace exitance
