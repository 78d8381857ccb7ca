#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>

namespace exitance {

/// Runs `work` in a forked copy of this process, which is then discarded, so that a crash does no harm. For libraries
/// that do not validate their input: if the copy survives, reading the same bytes in this process is safe. The copy has
/// only one thread, so `work` must not wait for others.
/// work     returns true on success; may throw std::bad_alloc if it gets too little memory
/// seconds  limit of its processor time, rounded up to whole seconds; a copy that waits is ended after 30 s + 10 *
/// `seconds` of elapsed time
/// memory   limit of its additional address space, bytes; not enforced under the address sanitizer, whose shadow memory
/// counts as address space, nor without /proc
/// returns  how `work` failed ("fails", "crashes", "takes more than 2 s", "asks for more than 65 MiB"), or nothing if
/// it succeeded, the copy only waited, or no process could be created
std::optional<std::string> rehearse(const std::function<bool()>& work, double seconds,
                                    std::size_t memory = std::numeric_limits<std::size_t>::max());

/// Whether a file was already read by the library in a rehearsal. Pass `already` only if the caller has done that
/// itself.
enum class Rehearsed { not_yet, already };

}  // namespace exitance
