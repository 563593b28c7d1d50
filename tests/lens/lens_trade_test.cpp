#include "lens/lens_trade.h"

#include <doctest/doctest.h>

#include "tests/lens/fitted_lenses.h"

namespace etendue {

TEST_CASE("Lens trade: more terms cost more and err less, and every quantity is measured") {
    FitSettings settings = smallSettings();
    const TradeRow few = measureTrade(doubleGauss(), doubleGaussDomain(), settings);
    settings.terms = 24;
    settings.degree = 9;
    const TradeRow many = measureTrade(doubleGauss(), doubleGaussDomain(), settings);
    CHECK(many.multiplyAdds > few.multiplyAdds);
    CHECK(many.errors.directionMrad.rms < 0.2 * few.errors.directionMrad.rms);
    for (const TradeRow& row : {few, many}) {
        CHECK(row.fitSeconds > 0.0);
        CHECK(row.evaluationNs > 0.0);
        CHECK(row.traceNs > 0.0);
        CHECK(row.connectNs > 0.0);
        CHECK(row.connectRays == 2000);
        CHECK(row.connectFailures == 0);
    }
}

TEST_CASE("Lens trade: the sensor-state form pays for two polynomials") {
    FitSettings settings = smallSettings();
    const LensFit twoPoint = fitLens(doubleGauss(), doubleGaussDomain(), settings);
    CHECK(rayMultiplyAdds(twoPoint) == multiplyAdds(twoPoint.exit));
    settings.form = FitForm::sensorState;
    const LensFit sensorState = fitLens(doubleGauss(), doubleGaussDomain(), settings);
    CHECK(rayMultiplyAdds(sensorState) ==
          multiplyAdds(sensorState.exit) + multiplyAdds(sensorState.aperture));
}

}  // namespace etendue
