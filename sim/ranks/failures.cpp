#include "failures.hpp"

#include <span>
#include <vector>

#include "detp/sim/base/stopped.hpp"

namespace detp::sim {
namespace {

enum class End { well, stopped, failed };

struct Report {
  End end = End::well;
  int rank = 0;
};

/// Sets the message, too.
Report report_of(const std::exception_ptr& failed, int rank, std::string& message) {
  End end = End::well;
  if (failed) try {
      end = End::failed;
      std::rethrow_exception(failed);
    } catch (const Stopped& stopped) {
      end = End::stopped;
      message = stopped.what();
    } catch (const std::exception& error) {
      message = error.what();
    } catch (...) {
      message = "an unknown exception";
    }
  return {end, rank};
}

void send_report(Ranks& ranks, const Report& report, const std::string& message, int to) {
  ranks.send_one(report, to);
  send_text(ranks, message, to);
}

Report receive_report(Ranks& ranks, std::string& message, int from) {
  const Report report = ranks.receive_one<Report>(from);
  message = receive_text(ranks, from);
  return report;
}

}  // namespace

bool is_stop(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Stopped&) {
    return true;
  } catch (...) {
    return false;
  }
}

void agree(Ranks& ranks, const std::exception_ptr& failed) {
  std::string message;
  Report first = report_of(failed, ranks.rank(), message);
  const bool own = first.end == End::failed;
  if (ranks.rank() == 0) {
    for (int from = 1; from < ranks.count(); ++from) {
      std::string theirs;
      const Report report = receive_report(ranks, theirs, from);
      if (first.end >= report.end) continue;
      first = report;
      message = theirs;
    }
    for (int to = 1; to < ranks.count(); ++to) send_report(ranks, first, message, to);
  } else {
    send_report(ranks, first, message, 0);
    first = receive_report(ranks, message, 0);
  }
  if (own) std::rethrow_exception(failed);
  if (first.end == End::failed) throw RankFailed(first.rank, message);
  if (failed) std::rethrow_exception(failed);
  if (first.end == End::stopped) throw Stopped(message);
}

}  // namespace detp::sim
