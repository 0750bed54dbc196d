#include "part_results.hpp"

#include <algorithm>
#include <vector>

namespace detp::sim {
namespace {

constexpr std::size_t at_once = std::size_t{1} << 14;

template <class Record>
void send_runs(const SortedRuns<Record>& runs, Ranks& ranks, int to) {
  ranks.send_one(runs.size(), to);
  typename SortedRuns<Record>::Reader reader(runs);
  std::vector<Record> block;
  Record record;
  while (reader.next(record)) {
    block.push_back(record);
    if (block.size() == at_once) {
      ranks.send_all(std::span<const Record>(block), to);
      block.clear();
    }
  }
  ranks.send_all(std::span<const Record>(block), to);
}

template <class Record>
void receive_runs(SortedRuns<Record>& runs, Ranks& ranks, int from) {
  auto left = ranks.receive_one<std::uint64_t>(from);
  std::vector<Record> block;
  runs.begin_run();
  for (; left > 0; left -= block.size()) {
    block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(left, at_once)));
    ranks.receive_all(std::span(block), from);
    runs.append(block);
  }
}

}  // namespace

void PartResults::add(const PartOfDiscs& part, const Totals& totals, std::span<const Pair> pairs) {
  sums_.begin_run();
  error_sums_.begin_run();
  for (std::size_t i = 0; i < part.discs.size(); ++i) {
    for (std::size_t band = 0; band < bands(); ++band) {
      const Totals& of_band = totals.band(band);
      const std::uint64_t place = std::uint64_t{part.numbers[i]} * bands() + band;
      const Sums one{place, {totals[i].hits, of_band.power(i, of_band[i]), part.discs[i].radius}};
      sums_.append(std::span(&one, 1));
      if (!errors_) continue;
      const PhotonSums& photons = of_band.photon_sums(i);
      const Errors error{place,
                         {of_band.squares(i, photons), photons.largest, photons.photons, of_band.unit_exponent()}};
      error_sums_.append(std::span(&error, 1));
    }
  }
  pairs_.begin_run();
  pairs_.append(pairs);
  for (std::size_t band = 0; band < bands(); ++band) {
    const Totals& of_band = totals.band(band);
    largest_powers_[band] =
        std::max(largest_powers_[band], heaviest_photon(of_band.photon_sums(), of_band.largest_power()));
  }
}

void PartResults::send(Ranks& ranks, int to) const {
  send_runs(sums_, ranks, to);
  send_runs(error_sums_, ranks, to);
  send_runs(pairs_, ranks, to);
}

void PartResults::receive(Ranks& ranks, int from) {
  receive_runs(sums_, ranks, from);
  receive_runs(error_sums_, ranks, from);
  receive_runs(pairs_, ranks, from);
}

void PartResults::finish(std::span<const double> heaviest, std::uint64_t photons, double scale) {
  heaviest_.assign(heaviest.begin(), heaviest.end());
  photons_ = static_cast<double>(photons);
  scale_ = scale;
}

}  // namespace detp::sim
