#pragma once

#include <string>

#include "exitance/io/view_factors/text_format.hpp"

namespace exitance {

/// An object ZoneProperty:UserViewFactors:BySurfaceName of EnergyPlus with all pairs of surfaces, zeros included:
/// EnergyPlus expects them. View factors are from the first surface of a triple to the second.
class EnergyPlus final : public TextFormat {
  public:
    EnergyPlus(const SparseFactors& table, const std::string& zone) : TextFormat(table), zone_(zone) {}
    void begin(std::string& text) const override;
    void add_row(std::string& text, std::size_t i) const override;

  private:
    std::string zone_;
};

/// CSV with the columns from_id, to_id and F: one line per entry, ids from 0 in the order of rows. With the sky, column
/// n is the sky and column n + 1 the backs of faces.
class FactorPairs final : public TextFormat {
  public:
    FactorPairs(const SparseFactors& table, bool with_sky) : TextFormat(table), with_sky_(with_sky) {}
    void begin(std::string& text) const override { text = "from_id,to_id,F\n"; }
    void add_row(std::string& text, std::size_t i) const override;

  private:
    bool with_sky_;
};

/// OpenFOAM's list of lists `F`: the entries of every row above 0.
class OpenFoamFactors final : public TextFormat {
  public:
    using TextFormat::TextFormat;
    void begin(std::string& text) const override;
    void add_row(std::string& text, std::size_t i) const override;
    void end(std::string& text) const override { text += ")\n"; }
};

/// OpenFOAM's list of lists `globalFaceFaces`: the column of every entry of `F`, from 0.
class OpenFoamColumns final : public TextFormat {
  public:
    using TextFormat::TextFormat;
    void begin(std::string& text) const override;
    void add_row(std::string& text, std::size_t i) const override;
    void end(std::string& text) const override { text += ")\n"; }
};

}  // namespace exitance
