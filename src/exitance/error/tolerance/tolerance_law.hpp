#pragma once

namespace exitance {

/// Lowers a tolerance from round to round until the accumulated error is within the allowed one.
///
/// A lower tolerance creates more links, so that their total error falls more slowly than the tolerance: like a power
/// of it that depends on the scene. The power is a guess at first, later an estimate from the last two rounds.
class ToleranceLaw {
  public:
    /// The tolerance is lowered in proportion to the error to the power `exponent`, or faster.
    explicit ToleranceLaw(double exponent) : exponent_(exponent) {}

    /// Returns the factor by which to multiply the tolerance after a round with this error; 1 if the error is allowed.
    /// The estimate of the power ignores the first round, since its light lacks reflections.
    double factor(double error, double allowed);

    template <class Archive>
    void archive_state(Archive& a) {
        a(round_, last_error_, last_factor_);
    }

  private:
    double exponent_;
    int round_ = 0;
    double last_error_ = 0, last_factor_ = 1;
};

}  // namespace exitance
