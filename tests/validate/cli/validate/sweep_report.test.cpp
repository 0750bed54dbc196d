#include "detp/validate/cli/validate/validate_report.hpp"

#include <doctest/doctest.h>

#include "support/scratch_file.hpp"

using namespace detp;
using support::content_of;
using support::ScratchFolder;

TEST_SUITE("sweep") {
  TEST_CASE("the rows of a sweep hold both forms of a prediction beside one observation; exact counts have no row") {
    validate::Deviation count{.technique = "sphere-cache",
                              .parameters = "Q 0.5, k 3",
                              .quantity = "m_i",
                              .sphere = 2,
                              .form = Form::published,
                              .predicted = 123456.7,
                              .observed = {120000, 350}};
    count.samples = 1e4;
    count.disc_share = 0.01;
    validate::Deviation corrected = count;
    corrected.form = Form::corrected;
    corrected.predicted = 119000;
    validate::Deviation other = corrected;
    other.sphere = 3;
    validate::Deviation exact = corrected;
    exact.sphere = 4;
    exact.observed = {119000, 0};
    const ScratchFolder folder;
    cli::write_sweep_rows(folder.path("rows"), {count, corrected, other, exact});
    CHECK(content_of(folder.path("rows")) ==
          "dimension,samples,disc_share,technique,parameters,quantity,sphere,published,corrected,observed,"
          "standard_error\n"
          "3,10000,0.01,sphere-cache,\"Q 0.5, k 3\",m_i,2,1.2346e+05,1.19e+05,1.2e+05,3.5e+02\n"
          "3,10000,0.01,sphere-cache,\"Q 0.5, k 3\",m_i,3,,1.19e+05,1.2e+05,3.5e+02\n");
  }
}
