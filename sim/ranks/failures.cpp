#include "failures.hpp"

#include <span>
#include <vector>

namespace detp::sim {
namespace {

std::string message_of(const std::exception_ptr& failed) {
  if (!failed) return "";
  try {
    std::rethrow_exception(failed);
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an unknown exception";
  }
}

struct Report {
  int failed = 0;
  int rank = 0;
  std::size_t length = 0;
};

void send_report(Ranks& ranks, const Report& report, const std::string& message, int to) {
  ranks.send_one(report, to);
  ranks.send_all(std::span(message.data(), message.size()), to);
}

Report receive_report(Ranks& ranks, std::string& message, int from) {
  const Report report = ranks.receive_one<Report>(from);
  message.resize(report.length);
  ranks.receive_all(std::span(message.data(), message.size()), from);
  return report;
}

}  // namespace

void agree(Ranks& ranks, const std::exception_ptr& failed) {
  std::string message = message_of(failed);
  Report first{failed ? 1 : 0, ranks.rank(), message.size()};
  if (ranks.rank() == 0) {
    for (int from = 1; from < ranks.count(); ++from) {
      std::string theirs;
      const Report report = receive_report(ranks, theirs, from);
      if (first.failed != 0 || report.failed == 0) continue;
      first = report;
      message = theirs;
    }
    for (int to = 1; to < ranks.count(); ++to) send_report(ranks, first, message, to);
  } else {
    send_report(ranks, first, message, 0);
    first = receive_report(ranks, message, 0);
  }
  if (failed) std::rethrow_exception(failed);
  if (first.failed != 0) throw RankFailed(first.rank, message);
}

}  // namespace detp::sim
