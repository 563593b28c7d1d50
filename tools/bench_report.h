// The report of a benchmark: its figures and pictures, in one page (bench_page.h).
#pragma once

#include <string>
#include <vector>

#include "tools/bench_run.h"
#include "tools/bench_summary.h"
#include "tools/json.h"

namespace etendue {

/// All that the page shows (docs/benchmarks.md, "report data").
Json benchReportData(const BenchSuite& suite, const BenchRecords& records,
                     const std::vector<BenchResult>& results, const BenchFolder& folder,
                     bool isComplete);

/// The page. Pictures are read from the folder; one that is missing is left out.
std::string benchReport(const BenchSuite& suite, const BenchRecords& records,
                        const std::vector<BenchResult>& results, const BenchFolder& folder,
                        bool isComplete);

}  // namespace etendue
