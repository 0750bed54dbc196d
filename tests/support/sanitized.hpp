#pragma once

/// DETP_SANITIZED is defined in a build with a sanitizer, which needs additional memory and time.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DETP_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DETP_SANITIZED
#endif
#endif

namespace detp::support {

#ifdef DETP_SANITIZED
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace detp::support
