#pragma once

#include <zlib.h>

#include <stdexcept>
#include <string>

namespace detp::support {

/// The text compressed by zlib: as gzip does, or without a head and an end, as in ZIP archives.
inline std::string packed(const std::string& text, bool as_gzip = true) {
  z_stream state{};
  if (deflateInit2(&state, Z_BEST_SPEED, Z_DEFLATED, as_gzip ? 16 + MAX_WBITS : -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) !=
      Z_OK)
    throw std::runtime_error("zlib does not begin");
  std::string out(deflateBound(&state, text.size()), '\0');
  std::string in = text;
  state.next_in = reinterpret_cast<Bytef*>(in.data());
  state.avail_in = static_cast<uInt>(in.size());
  state.next_out = reinterpret_cast<Bytef*>(out.data());
  state.avail_out = static_cast<uInt>(out.size());
  const int result = deflate(&state, Z_FINISH);
  out.resize(state.total_out);
  deflateEnd(&state);
  if (result != Z_STREAM_END) throw std::runtime_error("zlib does not end");
  return out;
}

}  // namespace detp::support
