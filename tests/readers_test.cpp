#include <gtest/gtest.h>

#include "exitance/io/export/export.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "support/places.hpp"
#include "support/run.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// True if this machine has the Python packages of the other readers.
bool have_readers() {
    return run("/usr/bin/python3 -c 'import h5py, numpy, vtk'").status == 0;
}

const std::string scripts = test::source_folder() + "/tests/readers/";

TEST(Readers, OfPythonAndVtkReadSolutions) {
    if (bands != 3 || !have_readers()) return;
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution(600)));
    const Ran ran = run("/usr/bin/python3 '" + scripts + "read_solution.py' '" + folder / "s.h5" + "'");
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_TRUE(ran.output.ends_with("good\n")) << ran.output;
}

TEST(Readers, OfPythonAndVtkReadExports) {
    if (bands != 3 || !have_readers()) return;
    const TemporaryFolder folder;
    const Solution solution = sample_solution(600);
    for (const char* name : {"s.vtkhdf", "s.vtu", "s.glb", "s.obj", "s.csv"}) {
        const Result<void> written = export_solution(solution, folder / name);
        ASSERT_TRUE(written) << written.error().message;
    }
    const Ran ran = run("/usr/bin/python3 '" + scripts + "read_export.py' '" + folder / "" + "'");
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_TRUE(ran.output.ends_with("good\n")) << ran.output;
}

}  // namespace
}  // namespace exitance
