#pragma once

namespace exitance {

/// True if the program is built with the address sanitizer, whose shadow memory fills the address space and which is
/// slow.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool has_address_sanitizer = true;
#elif defined(__has_feature)
constexpr bool has_address_sanitizer = __has_feature(address_sanitizer);
#else
constexpr bool has_address_sanitizer = false;
#endif

}  // namespace exitance
