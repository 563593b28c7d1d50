#include "tools/lens_report.h"

namespace etendue {

namespace {

template <class Values, class Of>
Json column(const Values& values, const Of& of) {
    Json result = Json::array();
    for (const auto& value : values) result.add(Json(of(value)));
    return result;
}

Json jsonOf(const DistortionResidual& residual) {
    return Json::object({{"rms_mm", residual.rmsMm}, {"most_mm", residual.mostMm}});
}

Json focalLength(const Eigen::Vector2d& f) { return Json::numbers({f.x(), f.y()}); }

Json jsonOf(const PinholeDistortion& p) {
    return Json::object({{"focal_length_mm", focalLength(p.focalLengthMm)},
                         {"k1_k2_p1_p2_k3", Json::numbers({p.k1, p.k2, p.p1, p.p2, p.k3})},
                         {"residual", jsonOf(p.residual)}});
}

Json jsonOf(const FisheyeDistortion& f) {
    return Json::object({{"focal_length_mm", focalLength(f.focalLengthMm)},
                         {"k1_k2_k3_k4", Json::numbers({f.k.begin(), f.k.end()})},
                         {"residual", jsonOf(f.residual)}});
}

/// Points in the frame of ReportSpot, those of rays that do not pass as null.
Json pointsJson(const std::vector<Eigen::Vector2d>& points) {
    return Json::object({{"outward_mm", column(points, [](const auto& p) { return p.x(); })},
                         {"across_mm", column(points, [](const auto& p) { return p.y(); })}});
}

Json jsonOf(const ReportSpot& spot) {
    Json lines = Json::array();
    for (std::size_t line = 0; line < reportLinesNm.size(); ++line)
        lines.add(Json::object({{"wavelength_nm", reportLinesNm[line]},
                                {"exact", pointsJson(spot.exact[line])},
                                {"fitted", pointsJson(spot.fitted[line])}}));
    return Json::object({{"axis", spot.axis.name},
                         {"height_mm", spot.heightMm},
                         {"field_degrees", spot.fieldDegrees},
                         {"exact_rms_mm", spot.exactRmsMm},
                         {"fitted_rms_mm", spot.fittedRmsMm},
                         {"largest_shift_mm", spot.largestShiftMm},
                         {"lines", std::move(lines)}});
}

Json jsonOf(const ReportCurves& curves) {
    const auto& d = curves.distortion;
    const auto& i = curves.illumination;
    const auto& f = curves.fieldCurvature;
    Json lines = Json::array();
    for (std::size_t line = 0; line < reportLinesNm.size(); ++line)
        lines.add(Json::object({{"wavelength_nm", reportLinesNm[line]},
                                {"lateral_mm", Json::numbers(curves.lateralMm[line])},
                                {"focus_shift_mm", Json::numbers(curves.focusShiftMm[line])}}));
    return Json::object(
        {{"axis", curves.axis.name},
         {"distortion",
          Json::object({{"height_mm", column(d, [](const auto& p) { return p.heightMm; })},
                        {"field_degrees", column(d, [](const auto& p) { return p.fieldDegrees; })},
                        {"from_f_tan_percent",
                         column(d, [](const auto& p) { return p.rectilinearPercent; })},
                        {"from_f_theta_percent",
                         column(d, [](const auto& p) { return p.equidistantPercent; })}})},
         {"illumination",
          Json::object({{"height_mm", column(i, [](const auto& p) { return p.heightMm; })},
                        {"total", column(i, [](const auto& p) { return p.total; })},
                        {"cos_fourth", column(i, [](const auto& p) { return p.cosFourth; })},
                        {"vignetting", column(i, [](const auto& p) { return p.vignetting; })},
                        {"rest", column(i, [](const auto& p) { return p.rest; })}})},
         {"colour", Json::object({{"height_mm", Json::numbers(curves.heightsMm)},
                                  {"aperture_share", Json::numbers(curves.apertureShares)},
                                  {"lines", std::move(lines)}})},
         {"field_curvature",
          Json::object(
              {{"height_mm", Json::numbers(curves.heightsMm)},
               {"tangential_focus_mm", column(f, [](const auto& p) { return p.tangentialMm; })},
               {"sagittal_focus_mm", column(f, [](const auto& p) { return p.sagittalMm; })}})},
         {"fit_error",
          Json::object({{"height_mm", Json::numbers(curves.map.heightsMm)},
                        {"aperture_mm", Json::numbers(curves.map.aperturesMm)},
                        {"direction_mrad_row_by_row", Json::numbers(curves.map.directionMrad)}})}});
}

Json jsonOf(const ConnectRing& ring) {
    return Json::object({{"low_mm", ring.lowMm},
                         {"high_mm", ring.highMm},
                         {"field_degrees", ring.fieldDegrees},
                         {"rays", ring.rays},
                         {"failures", ring.failures},
                         {"other_points", ring.otherPoints},
                         {"mean_iterations", ring.meanIterations},
                         {"most_iterations", ring.mostIterations}});
}

template <class Item>
Json list(const std::vector<Item>& items) {
    Json result = Json::array();
    for (const Item& item : items) result.add(jsonOf(item));
    return result;
}

}  // namespace

Json jsonOf(const LensReport& report) {
    Json json = Json::object({{"lens", jsonOf(report.info)},
                              {"spots", list(report.spots)},
                              {"curves", list(report.curves)}});
    const auto& focus = report.paraxialFocusMm;
    json.add("paraxial_focus",
             Json::object(
                 {{"wavelength_nm", column(focus, [](const auto& p) { return p.x(); })},
                  {"in_front_of_sensor_mm", column(focus, [](const auto& p) { return p.y(); })}}));
    if (report.pinhole) json.add("opencv_pinhole", jsonOf(*report.pinhole));
    if (report.fisheye) json.add("opencv_fisheye", jsonOf(*report.fisheye));
    json.add("fit", jsonOf(report.fit.fit));
    json.add("connect",
             Json::object({{"newton", list(report.newton)}, {"two_step", list(report.twoStep)}}));
    return json;
}

}  // namespace etendue
