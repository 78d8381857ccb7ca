#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/view_factors/row_factors.hpp"

namespace exitance {

/// A work file with rows of view factors, one checksummed record per row, so that an interrupted run can resume from
/// the rows that are complete. Only the same program on the same kind of machine can read it.
class RawRowFile final : public RawRowStore {
  public:
    /// Opens the work file.
    /// path    the file; without `resume`, one that has rows is renamed, see set_aside()
    /// work    a line that identifies the scene, the options and the program
    /// resume  whether to read the rows of an earlier run with the same `work`
    /// faces   number of faces of the scene
    /// Errors: bad_input if the file belongs to other work or is of another kind, cannot_write.
    static Result<RawRowFile> open(const std::string& path, const std::string& work, bool resume, std::size_t faces);

    std::vector<RawRow> resumed() override { return std::move(resumed_); }
    void keep(const RawRow& row) override;
    void flush() override;

    /// False if a write has failed: rows after that point are not in the file.
    bool is_whole() const { return !failed_; }
    const std::string& path() const { return path_; }
    /// Number of rows of an earlier run that open() did not resume but renamed to set_aside_path().
    std::size_t set_aside() const { return set_aside_; }
    std::string set_aside_path() const { return path_ + ".old"; }
    /// Closes and removes the file, and the rows that were set aside.
    void remove();
    /// Closes and removes the file; restores the rows that were set aside.
    void withdraw();

  private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    RawRowFile() = default;
    /// Reads all complete records and returns their total length, bytes.
    long read_records(std::size_t faces);

    std::string path_;
    std::unique_ptr<std::FILE, Close> file_;
    std::vector<RawRow> resumed_;
    std::size_t set_aside_ = 0;
    bool failed_ = false;
};

}  // namespace exitance
