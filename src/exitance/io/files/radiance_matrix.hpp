#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exitance/io/files/atomic_file.hpp"

namespace exitance {

/// Encodings of the numbers in Radiance's matrices.
enum class MatrixFormat : std::uint8_t { ascii, float32, float64 };

/// Writes a matrix of Radiance (.mtx; header with NROWS, NCOLS, NCOMP, FORMAT) row by row, with three equal components
/// per number, as dctimestep and rmtxop expect. The file appears whole or not at all.
class RadianceMatrixWriter {
  public:
    /// Error: ErrorCode::cannot_write.
    static Result<RadianceMatrixWriter> create(const std::string& path, MatrixFormat format, std::size_t rows,
                                               std::size_t columns);
    void append_row(std::span<const double> values);
    Result<void> commit() { return file_.commit(); }

  private:
    RadianceMatrixWriter(AtomicFile file, MatrixFormat format) : file_(std::move(file)), format_(format) {}

    AtomicFile file_;
    MatrixFormat format_;
};

/// A matrix: row by row, `components` consecutive numbers per entry.
struct RadianceMatrix {
    std::size_t rows = 0, columns = 0, components = 0;
    std::vector<float> values;
};

/// Reads a matrix of rmtxop, rfluxmtx, rcontrib or gendaymtx: ascii, float or double, in either byte order. If the
/// header has no NROWS, they follow from the size. Errors: cannot_read; bad_input for other formats and for files that
/// have fewer numbers than their header states.
Result<RadianceMatrix> read_radiance_matrix(const std::string& path);

}  // namespace exitance
