#pragma once
// Analysis of variance of one threshold for each person and condition, and Tukey's test.

#include <cstddef>
#include <vector>

namespace touchstone::experiment {

/// values[person][condition].
using Thresholds = std::vector<std::vector<double>>;

struct Mean {
    double mean = 0.0;
    double deviation = 0.0; ///< standard deviation over people
    double half = 0.0;      ///< of the 95 % interval of the mean, Student's t
};

struct FTest {
    double f = 0.0, between = 0.0, within = 0.0; ///< degrees of freedom
    double error = 0.0;                          ///< mean square of the error
    double p = 1.0;
};

/// Two conditions; the honestly significant difference of Tukey.
struct Comparison {
    size_t first = 0, second = 0;
    double difference = 0.0; ///< mean of the second - of the first
    double q = 0.0, p = 1.0;
};

struct Variance {
    std::vector<Mean> means{}; ///< by condition
    FTest repeated{};          ///< people are blocks: F(k - 1, (k - 1)(n - 1))
    FTest independent{}; ///< as if each value came from another person: F(k - 1, k (n - 1)), as [004] reports
    double epsilon = 1.0;            ///< Greenhouse and Geisser's: how far from sphericity, 1/(k - 1)..1
    double correctedP = 1.0;         ///< of `repeated` with both degrees times epsilon
    std::vector<Comparison> tukey{}; ///< all pairs, with the error of `repeated`
    std::vector<Comparison> tukeyIndependent{}; ///< with that of `independent`
};

/// Throws Error for fewer than two people or conditions, rows of different lengths, or a value that is not
/// finite. Without `probabilities` Tukey's pairs have no p (1): it is an integral of two dimensions each. Any
/// thread.
[[nodiscard]] Variance analyse(const Thresholds& values, bool probabilities = true);

[[nodiscard]] Mean meanOf(const std::vector<double>& values);

} // namespace touchstone::experiment
