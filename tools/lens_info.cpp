#include "tools/lens_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/text_table.h"

namespace etendue {

namespace {

constexpr std::array<const char*, 7> kindNames{"spherical",  "conic",  "aspheric", "cylinder-x",
                                               "cylinder-y", "planar", "stop"};

std::string kindName(const Surface& surface) {
    return kindNames[static_cast<std::size_t>(surface.kind)];
}

/// One number, or that in x and that in y where they differ.
std::string both(const LensInfo& info, double x, double y, const char* unit) {
    return isAnamorphic(info.prescription)
               ? fmt::format("{:.3f} {} in x, {:.3f} {} in y", x, unit, y, unit)
               : fmt::format("{:.3f} {}", y, unit);
}

/// `zMm` seen from a vertex.
std::string place(double zMm, double vertexZMm, const char* vertex) {
    if (!std::isfinite(zMm)) return "at infinity";
    const double behind = vertexZMm - zMm;
    return fmt::format("{:.3f} mm {} the {} vertex", std::abs(behind),
                       behind >= 0.0 ? "behind" : "in front of", vertex);
}

std::string places(const LensInfo& info, double ParaxialAxis::*zMm, double vertexZMm,
                   const char* vertex) {
    const std::string y = place(info.paraxial.y.*zMm, vertexZMm, vertex);
    const std::string x = place(info.paraxial.x.*zMm, vertexZMm, vertex);
    return x == y ? y : fmt::format("{} in x, {} in y", x, y);
}

std::string diameters(const LensInfo& info, double ParaxialAxis::*perStop) {
    const auto diameter = [&](const ParaxialAxis& axis) {
        return 2.0 * std::abs(axis.*perStop) * info.stopRadiusMm;
    };
    return "⌀ " + both(info, diameter(info.paraxial.x), diameter(info.paraxial.y), "mm");
}

std::string angle(double degrees) {
    return std::isfinite(degrees) ? fmt::format("{:.2f}°", degrees)
                                  : std::string("beyond the picture");
}

Json jsonOf(const ParaxialAxis& axis, double stopRadiusMm) {
    return Json::object({{"focal_length_mm", axis.focalLengthMm},
                         {"back_focal_distance_mm", axis.backFocalDistanceMm},
                         {"front_focal_distance_mm", axis.frontFocalDistanceMm},
                         {"front_principal_z_mm", axis.frontPrincipalZMm},
                         {"rear_principal_z_mm", axis.rearPrincipalZMm},
                         {"entrance_pupil_z_mm", axis.entrancePupilZMm},
                         {"entrance_pupil_radius_mm", axis.entrancePupilRadiusMm(stopRadiusMm)},
                         {"exit_pupil_z_mm", axis.exitPupilZMm},
                         {"exit_pupil_radius_mm", axis.exitPupilRadiusMm(stopRadiusMm)}});
}

Json jsonOf(const Surface& surface) {
    Json json = Json::object({{"type", kindName(surface)},
                              {"radius_mm", surface.radiusMm},
                              {"thickness_mm", surface.thicknessMm},
                              {"semi_aperture_mm", surface.semiApertureMm},
                              {"index_d", refractiveIndex(surface.behind, dLineNm)},
                              {"index_F", refractiveIndex(surface.behind, fLineNm)},
                              {"index_C", refractiveIndex(surface.behind, cLineNm)},
                              {"abbe_number", abbeNumber(surface.behind)}});
    if (surface.conic != 0.0) json.add("conic", surface.conic);
    if (surface.kind == SurfaceKind::aspheric)
        json.add("asphere_a4_to_a16",
                 Json::numbers({surface.asphere.begin(), surface.asphere.end()}));
    if (surface.coating)
        json.add("coating",
                 Json::object({{"index", surface.coating->index},
                               {"design_wavelength_nm", surface.coating->designWavelengthNm},
                               {"thickness_waves", surface.coating->thicknessWaves}}));
    return json;
}

/// What no column of the table holds.
std::string remarks(const Surface& surface) {
    std::string text;
    if (surface.conic != 0.0) text += fmt::format(" k = {:g}", surface.conic);
    for (std::size_t i = 0; i < surface.asphere.size(); ++i)
        if (surface.asphere[i] != 0.0)
            text += fmt::format(" a{} = {:g}", 4 + 2 * i, surface.asphere[i]);
    if (surface.coating) text += fmt::format(" coated, n = {:g}", surface.coating->index);
    return text.empty() ? text : text.substr(1);
}

}  // namespace

double fNumberOf(const ParaxialData& paraxial, const AxialBeam& beam) {
    return 0.5 * std::sqrt(paraxial.x.focalLengthMm / beam.radiusXMm * paraxial.y.focalLengthMm /
                           beam.radiusYMm);
}

LensInfo lensInfo(const LensChoice& choice) {
    const Prescription prescription = loadPrescription(choice);
    const auto lens = makeTracedLens(prescription, settingsOf(choice));
    const OpticalSystem& system = lens->system();
    LensInfo info{prescription,
                  paraxialData(system),
                  system.aperture.radiusMm(),
                  widestAxialBeam(system),
                  0.0,
                  -lens->sensorZMm() - lengthMm(prescription),
                  {choice.sensorMm[0], choice.sensorMm[1]},
                  fieldOfView(*lens, choice.sensorMm[0], choice.sensorMm[1]),
                  imageCircleRadiusMm(*lens)};
    info.fNumber = fNumberOf(info.paraxial, info.beam);
    return info;
}

std::vector<InfoRow> infoRows(const LensInfo& info) {
    const ParaxialAxis &x = info.paraxial.x, &y = info.paraxial.y;
    const double last = info.paraxial.lastVertexZMm;
    const FieldOfView& field = info.field;
    return {
        {"symmetry", isAnamorphic(info.prescription) ? "anamorphic, two mirror planes" : "axial"},
        {"focal length", both(info, x.focalLengthMm, y.focalLengthMm, "mm")},
        {"back focal distance", both(info, x.backFocalDistanceMm, y.backFocalDistanceMm, "mm")},
        {"front focal distance", both(info, x.frontFocalDistanceMm, y.frontFocalDistanceMm, "mm")},
        {"front principal plane", places(info, &ParaxialAxis::frontPrincipalZMm, 0.0, "first")},
        {"rear principal plane", places(info, &ParaxialAxis::rearPrincipalZMm, last, "last")},
        {"entrance pupil", places(info, &ParaxialAxis::entrancePupilZMm, 0.0, "first")},
        {"", diameters(info, &ParaxialAxis::entrancePupilPerStop)},
        {"exit pupil", places(info, &ParaxialAxis::exitPupilZMm, last, "last")},
        {"", diameters(info, &ParaxialAxis::exitPupilPerStop)},
        {"f-number",
         fmt::format("f/{:.2f}, paraxial f/{:.2f}, stop ⌀ {:.3f} mm, limited by surface[{}]",
                     info.fNumber, fNumber(info.paraxial, info.stopRadiusMm),
                     2.0 * info.stopRadiusMm, info.beam.limitingSurface)},
        {"length",
         fmt::format("{:.3f} mm, {:.3f} mm to the sensor", -last, info.sensorDistanceMm - last)},
        {"sensor",
         fmt::format("{:g} × {:g} mm, {:.3f} mm behind the last vertex", info.sensorSizeMm.x(),
                     info.sensorSizeMm.y(), info.sensorDistanceMm)},
        {"field of view", fmt::format("{} × {}, diagonal {}", angle(field.horizontalDegrees),
                                      angle(field.verticalDegrees), angle(field.diagonalDegrees))},
        {"image circle", fmt::format("⌀ {:.2f} mm, where 5 % of the light on the axis is left",
                                     2.0 * info.imageCircleRadiusMm)},
    };
}

std::vector<std::vector<std::string>> surfaceTable(const Prescription& prescription) {
    std::vector<std::vector<std::string>> rows{
        {"#", "type", "radius", "thickness", "n_d", "n_F", "n_C", "v_d", "semi-aperture", ""}};
    for (std::size_t i = 0; i < prescription.surfaces.size(); ++i) {
        const Surface& s = prescription.surfaces[i];
        std::vector<std::string> row{
            std::to_string(i), kindName(s),
            std::isinf(s.radiusMm) ? "∞" : fmt::format("{:.3f}", s.radiusMm),
            fmt::format("{:.3f}", s.thicknessMm)};
        const bool isGlass = !std::holds_alternative<Air>(s.behind);
        for (const double line : {dLineNm, fLineNm, cLineNm})
            row.push_back(isGlass ? fmt::format("{:.5f}", refractiveIndex(s.behind, line)) : "");
        row.push_back(isGlass ? fmt::format("{:.2f}", abbeNumber(s.behind)) : "");
        row.push_back(fmt::format("{:.3f}", s.semiApertureMm));
        row.push_back(remarks(s));
        rows.push_back(std::move(row));
    }
    return rows;
}

Json jsonOf(const LensInfo& info) {
    const Prescription& p = info.prescription;
    Json surfaces = Json::array();
    for (const Surface& surface : p.surfaces) surfaces.add(jsonOf(surface));
    return Json::object(
        {{"name", p.name},
         {"source", p.source},
         {"zoom_position", p.zoomPosition},
         {"symmetry", isAnamorphic(p) ? "anamorphic" : "axial"},
         {"x", jsonOf(info.paraxial.x, info.stopRadiusMm)},
         {"y", jsonOf(info.paraxial.y, info.stopRadiusMm)},
         {"f_number", info.fNumber},
         {"paraxial_f_number", fNumber(info.paraxial, info.stopRadiusMm)},
         {"stop_radius_mm", info.stopRadiusMm},
         {"limiting_surface", info.beam.limitingSurface},
         {"length_mm", lengthMm(p)},
         {"sensor_distance_mm", info.sensorDistanceMm},
         {"sensor_size_mm", Json::numbers({info.sensorSizeMm.x(), info.sensorSizeMm.y()})},
         {"field_of_view_degrees", Json::object({{"horizontal", info.field.horizontalDegrees},
                                                 {"vertical", info.field.verticalDegrees},
                                                 {"diagonal", info.field.diagonalDegrees}})},
         {"image_circle_radius_mm", info.imageCircleRadiusMm},
         {"surfaces", std::move(surfaces)}});
}

ExitCode runLensInfo(const LensInfoCommand& command) {
    const LensInfo info = lensInfo(command.choice);
    if (command.asJson) {
        fmt::print("{}\n", jsonOf(info).text());
        return ExitCode::success;
    }
    const Prescription& p = info.prescription;
    fmt::print("{}\n{}\n\n", titleOf(p), p.source);
    for (const auto& [label, value] : infoRows(info)) fmt::print("  {:<22}{}\n", label, value);
    fmt::print("\n{}", alignedTable(surfaceTable(p), "rlrrrrrrrl"));
    if (!p.notes.empty()) fmt::print("\n{}\n", p.notes);
    return ExitCode::success;
}

}  // namespace etendue
