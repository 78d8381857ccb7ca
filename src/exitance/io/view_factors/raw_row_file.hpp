#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/view_factors/row_factors.hpp"

namespace exitance {

/// Rows of view factors in a work file, one record with a checksum after the other, so that a run that was ended in any
/// way can go on from those that are whole. Read by the program that wrote it and on the same kind of machine only.
class RawRowFile final : public RawRowStore {
  public:
    /// Opens the work file. Without `resume` an old one is emptied; with it, its rows are read if `work` is the same: a
    /// line that names the scene, the options and the program. Errors: bad_input for another work or a file of another
    /// kind, cannot_write.
    static Result<RawRowFile> open(const std::string& path, const std::string& work, bool resume, std::size_t faces);

    std::vector<RawRow> resumed() override { return std::move(resumed_); }
    void keep(const RawRow& row) override;
    void flush() override;

    /// False if the disk refused something: the rows kept end there.
    bool is_whole() const { return !failed_; }
    const std::string& path() const { return path_; }
    /// Closes and removes the file.
    void remove();

  private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    RawRowFile() = default;
    /// Reads all whole records; returns the length of what they take.
    long read_records(std::size_t faces);

    std::string path_;
    std::unique_ptr<std::FILE, Close> file_;
    std::vector<RawRow> resumed_;
    bool failed_ = false;
};

}  // namespace exitance
