#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>

namespace exitance {

/// Runs `work` in a copy of this process that is thrown away: what it breaks is broken there. For libraries that trust
/// files more than we do: what they survive in rehearsal they survive here, given the same bytes. The copy has one
/// thread, so that `work` must not wait for others.
/// work     returns whether all went well; may throw std::bad_alloc to say that it got less memory than it asked for
/// seconds  of processor time that it may take, at least; a copy that waits is ended after 30 s and ten times as long
///          by the clock
/// memory   bytes of address space that it may take beyond what the process has now; not watched under the address
///          sanitizer, whose shadow lies there, nor where /proc is not to be seen
/// returns  how it failed ("fails", "crashes", "takes more than 2 s", "asks for more than 65 MiB"), or nothing when
///          `work` returned. Where no process can be made, or it only waited, there is no rehearsal.
std::optional<std::string> rehearse(const std::function<bool()>& work, double seconds,
                                    std::size_t memory = std::numeric_limits<std::size_t>::max());

/// Has the library read a file before, where nothing is lost? Only who has seen to that himself says `already`.
enum class Rehearsed { not_yet, already };

}  // namespace exitance
