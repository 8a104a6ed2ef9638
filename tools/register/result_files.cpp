#include "tools/register/result_files.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <span>
#include <utility>

#include "sim/core/text.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "sim/files/new_folder.h"
#include "sim/reconstruction/reconstruction.h"
#include "sim/reconstruction/sweep_extent.h"
#include "sim/reconstruction/tracked_picture.h"
#include "sim/volume/ct_reader.h"
#include "tools/cli/about.h"
#include "tools/register/deformation_files.h"
#include "tools/register/itk_transform.h"

namespace insonate {
namespace {

constexpr std::size_t kShownImages = 4;
constexpr double kVoxel_mm = 1;  // of the sweep's volume
constexpr std::array<const char*, 12> kParameters{"tx", "ty", "tz", "rx",       "ry",       "rz",
                                                  "sx", "sy", "sz", "shear_yz", "shear_xz", "shear_xy"};

nlohmann::ordered_json probe_json(const TrackedSweep& sweep, const std::optional<FoundFan>& fan) {
  const Probe& probe = sweep.probe;
  nlohmann::ordered_json json;
  constexpr std::array<const char*, 3> kKinds{"linear", "curvilinear", "phased"};
  json["kind"] = kKinds[std::size_t(probe.kind)];
  if (probe.kind == ProbeKind::curvilinear) json["radius_mm"] = probe.radius_mm;
  if (probe.kind != ProbeKind::linear) json["field_of_view_deg"] = probe.field_of_view_deg;
  if (probe.kind != ProbeKind::curvilinear) json["width_mm"] = probe.width_mm;
  json["depth_mm"] = sweep.depth_mm;
  json["found_from_images"] = fan.has_value();
  if (!fan) return json;
  json["face_pixel"] = {fan->face_pixel.x, fan->face_pixel.y};
  json["clip"] = fan->clip;
  json["share_shown"] = fan->shown;
  json["share_with_echo"] = fan->filled;
  return json;
}

nlohmann::ordered_json numbers_of(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

nlohmann::ordered_json free_form_json(const FreeFormRegistration& found, const FreeFormSettings& settings) {
  nlohmann::ordered_json json;
  json["improved"] = found.is_improved();
  json["spacing_mm"] = settings.spacing_mm;
  json["smoothness_mm2"] = settings.smoothness_mm2;
  json["similarity_of_fitted"] = {found.fitted_before, found.fitted_after};
  json["similarity_of_held_out"] = {found.held_out_before, found.held_out_after};
  json["standard_error_of_held_out"] = found.held_out_error;
  json["rounds"] = found.rounds;
  json["evaluations"] = found.evaluations.size();
  json["seconds"] = found.seconds;
  if (!found.is_improved()) return json;
  json["least_jacobian"] = found.least_jacobian;
  json["bending_energy_mm-2"] = found.field.bending_energy();
  json["largest_displacement_mm"] = found.most_mm;
  json["map"] = "ct_from_sweep (p + d(p)), with d the sum of control points times cubic B-splines";
  json["origin_in_sweep"] = numbers_of(found.field.origin_mm);
  json["control_points"] = {found.field.size.x, found.field.size.y, found.field.size.z};
  nlohmann::ordered_json control = nlohmann::ordered_json::array();
  for (const glm::dvec3& each : found.field.control_mm) control.push_back(numbers_of(each));
  json["control_mm"] = std::move(control);
  return json;
}

std::string fixed(double value, int digits) {
  return formatted("%.*f", digits, value);
}

nlohmann::json rows_of(const glm::dmat4& matrix) {
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 4; ++row) {
    nlohmann::json numbers = nlohmann::json::array();
    for (int column = 0; column < 4; ++column) numbers.push_back(matrix[column][row]);
    rows.push_back(std::move(numbers));
  }
  return rows;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text)
    safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return safe;
}

std::string row(const std::string& name, const std::string& value) {
  return "<tr><th>" + name + "</th><td>" + value + "</td></tr>\n";
}

std::string figure(const std::string& file, const std::string& caption) {
  return "<figure><img alt='" + caption + "' src='" + file + "'><figcaption>" + caption + "</figcaption></figure>";
}

// A matrix by rows, as a person reads it; registration.json has all digits.
std::string matrix_row(const std::string& name, const glm::dmat4& matrix) {
  std::string lines;
  for (int r = 0; r < 4; ++r) {
    for (int column = 0; column < 4; ++column) lines += formatted("%12.6f", matrix[column][r]);
    lines += "\n";
  }
  return row(name, "<pre>" + lines + "</pre>");
}

std::string free_form_rows(const FreeFormRegistration& found, const FreeFormSettings& settings) {
  const auto change = [](double before, double after) { return fixed(before, 4) + " &rarr; " + fixed(after, 4); };
  return row("Control points of the deformation",
             formatted("%d x %d x %d, %g mm apart; weight of the bending energy %g mm&sup2;", found.field.size.x,
                       found.field.size.y, found.field.size.z, settings.spacing_mm, settings.smoothness_mm2)) +
         row("Similarity of the fitted images", change(found.fitted_before, found.fitted_after)) +
         row("Similarity of the other images",
             change(found.held_out_before, found.held_out_after) + " &plusmn; " + fixed(found.held_out_error, 4)) +
         row("Rounds and evaluations",
             formatted("%d and %zu in %.1f s", found.rounds, found.evaluations.size(), found.seconds));
}

constexpr char kStyle[] =
    "body{font:15px/1.5 sans-serif;color:#1d2733;max-width:1500px;margin:2em auto;padding:0 1em}"
    ".verdict{font-weight:600;padding:.6em 1em;border-left:6px solid #2e7d4f;background:#eef6f0}"
    ".verdict.no{border-color:#b3362b;background:#fbeeec}th{text-align:left;padding-right:2em;font-weight:400}"
    "td{font-variant-numeric:tabular-nums}pre{margin:0}.row{display:grid;gap:8px;"
    "grid-template-columns:repeat(5,minmax(0,1fr))}figure{margin:0 0 "
    "1em}img{width:100%;display:block}figcaption{font-size:12px;color:#5f6c7b}";

}  // namespace

std::string verdict(const SweepRegistration& found) {
  if (found.converged())
    return found.deviation.empty() ? "Converged; mutual information gives no expected error."
                                   : "Converged: the expected error from the similarity's curvature is " +
                                         fixed(found.expected_error_mm, 2) +
                                         " mm; where the truth was known, up to ten times that was measured.";
  std::string text = "Not converged: ";
  for (std::size_t i = 0; i < found.doubts.size(); ++i) text += (i > 0 ? ", and " : "") + found.doubts[i];
  const auto doubts = [&](const char* why) { return std::ranges::count(found.doubts, why) > 0; };
  const char* const help = doubts(kNotSearched)                   ? "Search widely around the start."
                           : doubts(kTooFew) || doubts(kTooClose) ? "Give more images, of a longer sweep."
                                                                  : "A nearer start may help, or a longer sweep.";
  return text + ". Do not use this transform. " + help;
}

std::string verdict(const RegistrationReport& report) {
  return verdict(report.found) + (report.free_form ? " " + sentence_about(*report.free_form) : std::string());
}

// Returns nothing for a folder, and for a file that cannot be read any more: the result is written without its digest.
std::optional<std::string> digest_of_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  std::vector<char> piece(1 << 20);
  Digest digest;
  while (in.read(piece.data(), std::streamsize(piece.size())) || in.gcount() > 0)
    digest.add({piece.data(), std::size_t(in.gcount())});
  return in.eof() ? std::optional(digest.text()) : std::nullopt;
}

std::string registration_json(const RegistrationReport& report) {
  const SweepRegistration& found = report.found;
  nlohmann::ordered_json json;
  json["format"] = 1;
  json["converged"] = found.converged();
  json["verdict"] = verdict(report);
  json["doubts"] = found.doubts;
  json["ct"] = report.ct.empty() ? "built-in" : report.ct;
  json["recording"] = report.recording;
  if (!report.input.transform.empty()) json["transform"] = report.input.transform;
  json["frames"] = report.input.frames;
  json["frames_left_out"] = report.input.left_out;
  json["share_left_out_at_ct_ends"] = report.input.share_at_ends;
  if (report.landmark_error_mm) json["landmark_error_mm"] = *report.landmark_error_mm;
  json["slices"] = report.input.sweep.images.size();
  json["probe"] = probe_json(report.input.sweep, report.input.fan);
  if (!report.input.found_in_volume.empty()) json["probe"]["found_in_volume"] = report.input.found_in_volume;
  json["coordinates"] = "LPS, mm; matrices by rows";
  json["ct_from_sweep"] = rows_of(found.ct_from_sweep);
  json["sweep_from_ct"] = rows_of(glm::inverse(found.ct_from_sweep));
  if (report.settings.freedom == Freedom::affine)
    json["ct_from_sweep_rigid"] =
        rows_of(found.motion.at(std::span(found.at).first(std::min(found.at.size(), parameters_of(Freedom::rigid)))));
  json["ct_from_sweep_at_start"] = rows_of(found.motion.ct_from_sweep);
  json["measure"] = std::string(to_string(report.settings.measure));
  json["similarity_before"] = found.similarity_before;
  json["similarity_after"] = found.similarity_after;
  json["similarity_of_runner_up"] = found.runner_up;
  json["similarity_elsewhere"] = found.elsewhere;
  nlohmann::ordered_json parameters;
  for (std::size_t i = 0; i < found.at.size(); ++i) {
    parameters[kParameters[i]]["mm"] = found.at[i];
    if (!found.deviation.empty()) parameters[kParameters[i]]["standard_deviation_mm"] = found.deviation[i];
  }
  json["parameters"] = parameters;
  json["radius_mm"] = found.motion.radius_mm;
  const glm::dvec3& centre = found.motion.centre_in_ct;
  json["centre_in_ct"] = {centre.x, centre.y, centre.z};
  if (!found.deviation.empty()) json["expected_error_mm"] = found.expected_error_mm;
  json["search_mm"] = report.settings.search_mm;
  json["search_deg"] = report.settings.search_deg;
  json["evaluations"] = found.evaluations.size();
  json["seconds"] = found.seconds;
  json["motion"] = report.settings.freedom == Freedom::affine ? "affine" : "rigid";
  json["patch"] = report.settings.wein.similarity_patch;
  if (!report.command.empty()) json["command"] = report.command;
  for (const auto& [name, file] : {std::pair("recording_digest", report.recording), std::pair("ct_digest", report.ct)})
    if (const auto digest = digest_of_file(file)) json[name] = *digest;
  for (const AboutLine& line : about_this_build()) json["made_by"][line.name] = line.text;
  json["made_by"]["OpenGL"] = report.device;
  if (report.free_form) json["free_form"] = free_form_json(*report.free_form, *report.free_form_settings);
  return json.dump(2) + "\n";
}

std::string evaluations_csv(const RegistrationReport& report) {
  const SweepRegistration& found = report.found;
  std::string csv = "evaluation,stage,similarity";
  for (std::size_t i = 0; i < found.at.size(); ++i) csv += std::string(",") + kParameters[i] + "_mm";
  csv += report.free_form ? ",bending_energy_mm-2\n" : "\n";
  std::size_t number = 0;
  for (const Evaluation& each : found.evaluations) {
    csv += std::to_string(number++) + "," + kStages[std::size_t(each.stage)] + "," + fixed(each.similarity, 6);
    for (std::size_t i = 0; i < found.at.size(); ++i) csv += "," + fixed(i < each.at.size() ? each.at[i] : 0, 4);
    csv += report.free_form ? ",\n" : "\n";
  }
  if (!report.free_form) return csv;
  for (const FreeFormEvaluation& each : report.free_form->evaluations)
    csv += std::to_string(number++) + (each.varied ? ",free-form vary," : ",free-form step,") +
           fixed(each.similarity, 6) + std::string(found.at.size() + 1, ',') +
           formatted("%.6g\n", each.bending_energy_mm2);
  return csv;
}

std::string registration_page(const RegistrationReport& report) {
  const SweepRegistration& found = report.found;
  std::string html = "<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><title>Registration</title><style>";
  html += kStyle;
  html += "</style></head><body>\n<h1>Registration of tracked ultrasound with CT</h1>\n<p class='verdict";
  html += found.converged() ? "" : " no";
  html += "'>" + escaped(verdict(report)) + "</p>\n<table>\n";
  html += row("CT", escaped(report.ct.empty() ? "the built-in patient" : report.ct));
  html += row("Recording", escaped(report.recording) + ", " + std::to_string(report.input.sweep.images.size()) +
                               " of " + std::to_string(report.input.frames) + " images");
  if (!report.input.transform.empty()) html += row("Transform of the probe", escaped(report.input.transform));
  if (report.input.share_at_ends > 0)
    html += row("Left out", fixed(100 * report.input.share_at_ends, 0) +
                                " % of the images, black in the pictures: there the CT ends");
  if (report.landmark_error_mm)
    html += row("Landmarks of the start", "fitted within " + fixed(*report.landmark_error_mm, 1) + " mm");
  if (report.input.fan) html += row("Probe, found from the images", escaped(description(*report.input.fan)));
  if (!report.input.found_in_volume.empty())
    html += row("Probe, found in the volume", escaped(report.input.found_in_volume));
  html += row("Similarity (" + std::string(to_string(report.settings.measure)) + ") before and after",
              fixed(found.similarity_before, 4) + " &rarr; " + fixed(found.similarity_after, 4));
  html += row("Similarity of the next best place", found.runner_up > 0 ? fixed(found.runner_up, 4) : "none was found");
  if (found.elsewhere > 0) html += row("Similarity that one in ten places far away exceeds", fixed(found.elsewhere, 4));
  const std::vector<double>& at = found.at;
  html += row("Moved from the start",
              fixed(std::hypot(at[0], at[1], at[2]), 1) + " mm, " +
                  fixed(std::hypot(at[3], at[4], at[5]) / found.motion.radius_mm * 180 / M_PI, 1) + " degrees");
  html += row("Evaluations", std::to_string(found.evaluations.size()) + " in " + fixed(found.seconds, 1) + " s");
  if (report.free_form) html += free_form_rows(*report.free_form, *report.free_form_settings);
  html += matrix_row("ct_from_sweep, in LPS and mm", found.ct_from_sweep);
  html +=
      "</table>\n<p>The blends show the ultrasound in orange and the CT in blue. Where both are bright they are "
      "white. The probe's marker is on the left.</p>\n";
  for (const ComparisonPictures& one : report.pictures)
    html += "<h2>Image " + std::to_string(one.image + 1) + " of " + std::to_string(report.input.sweep.images.size()) +
            " that were compared</h2>\n<div class='row'>" + figure(one.ultrasound, "Ultrasound") +
            figure(one.ct_before, "CT, before") + figure(one.blend_before, "Both, before") +
            figure(one.ct_after, "CT, after") + figure(one.blend_after, "Both, after") +
            (one.ct_deformed.empty()
                 ? std::string()
                 : figure(one.ct_deformed, "CT, deformed") + figure(one.blend_deformed, "Both, deformed")) +
            "</div>\n";
  return html + "</body></html>\n";
}

std::string slicer_scene(const std::string& why, bool is_deformed) {
  const std::string kind = is_deformed ? "GridTransform" : "LinearTransform", node = "vtkMRML" + kind + "Node1";
  const auto volume = [](int number, const std::string& name, const std::string& file, const std::string& window,
                         const std::string& more) {
    const std::string n = std::to_string(number);
    return "  <ScalarVolumeDisplay id=\"vtkMRMLScalarVolumeDisplayNode" + n +
           "\" colorNodeID=\"vtkMRMLColorTableNodeGrey\" " + window +
           " autoWindowLevel=\"0\"/>\n  <VolumeArchetypeStorage id=\"vtkMRMLVolumeArchetypeStorageNode" + n +
           "\" fileName=\"" + file + "\"/>\n  <Volume id=\"vtkMRMLScalarVolumeNode" + n + "\" name=\"" + name +
           "\" displayNodeRef=\"vtkMRMLScalarVolumeDisplayNode" + n +
           "\" storageNodeRef=\"vtkMRMLVolumeArchetypeStorageNode" + n + "\"" + more + "/>\n";
  };
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- " + escaped(why) +
         " -->\n<MRML version=\"Slicer4.4.0\" userTags=\"\">\n"
         "  <TransformStorage id=\"vtkMRMLTransformStorageNode1\" fileName=\"sweep_from_ct." +
         (is_deformed ? "nrrd" : "tfm") + "\"/>\n  <" + kind + " id=\"" + node +
         "\" name=\"ct_from_sweep\" storageNodeRef=\"vtkMRMLTransformStorageNode1\"/>\n" +
         volume(1, "CT", "ct.nrrd", "window=\"400\" level=\"50\"", "") +
         volume(2, "Sweep", "sweep.nrrd", "window=\"255\" level=\"127\"", " transformNodeRef=\"" + node + "\"") +
         "  <Selection id=\"vtkMRMLSelectionNodeSingleton\" activeVolumeID=\"vtkMRMLScalarVolumeNode1\" "
         "secondaryVolumeID=\"vtkMRMLScalarVolumeNode2\"/>\n</MRML>\n";
}

void write_registration(const std::filesystem::path& out, RegistrationReport report, const Volume<std::int16_t>& ct) {
  const SweepRegistration& found = report.found;
  const TrackedSweep& sweep = report.input.sweep;
  const FreeFormField* deformation = report.deformation();
  const std::string sentence = verdict(report),
                    of_matrix = deformation
                                    ? "The affine part alone; the .h5 and .nrrd files hold the whole map. " + sentence
                                    : sentence;
  write_folder(out, [&](const std::filesystem::path& folder) {
    report.pictures = write_comparison(folder / "pictures", sweep, ct, found.motion.ct_from_sweep, found.ct_from_sweep,
                                       deformation, kShownImages);
    write_file(folder / "registration.json", registration_json(report));
    const glm::dmat4 sweep_from_ct = glm::inverse(found.ct_from_sweep);
    const ItkTransform forth = itk_affine(found.ct_from_sweep), back = itk_affine(sweep_from_ct);
    write_file(folder / "ct_from_sweep.tfm", as_tfm(forth, of_matrix));
    write_file(folder / "sweep_from_ct.tfm", as_tfm(back, of_matrix));
    std::vector<ItkTransform> all_forth{forth}, all_back{back};
    if (deformation) {
      const DeformationGrids grids = deformation_grids(*deformation, found.ct_from_sweep);
      const auto deformed = [&](const glm::dvec3& p) { return deformation->at(p); };
      const auto undeformed = [&](const glm::dvec3& p) { return deformation->inverse(p); };
      write_displacements(folder / "ct_from_sweep.nrrd", grids.of_sweep, [&](const glm::dvec3& p) {
        return glm::dvec3(found.ct_from_sweep * glm::dvec4(deformed(p), 1));
      });
      write_displacements(folder / "sweep_from_ct.nrrd", grids.of_ct, [&](const glm::dvec3& p) {
        return undeformed(glm::dvec3(sweep_from_ct * glm::dvec4(p, 1)));
      });
      // The deformation lies in the sweep's frame, and is 0 from the grid's edge on.
      all_forth.push_back(itk_displacements(grids.of_sweep, deformed));
      all_back.insert(all_back.begin(), itk_displacements(grids.of_sweep, undeformed));
    }
    write_file(folder / "ct_from_sweep.h5", as_hdf5(all_forth, sentence));
    write_file(folder / "sweep_from_ct.h5", as_hdf5(all_back, sentence));
    write_file(folder / "evaluations.csv", evaluations_csv(report));
    write_file(folder / "index.html", registration_page(report));
    write_file(folder / "scene.mrml", slicer_scene(sentence, deformation != nullptr));
    write_ct(folder / "ct.nrrd", ct);
    write_labels(folder / "sweep.nrrd", volume_of(sweep));
  });
}

Volume<std::uint8_t> volume_of(const TrackedSweep& sweep) {
  std::vector<TrackedPicture> pictures;
  const Image<float>& first = sweep.images.front().grey;
  const ImageGeometry geometry = image_geometry(sweep.probe, sweep.depth_mm, first.width, first.height);
  const auto region = fan_region(sweep.probe, sweep.depth_mm, geometry);
  for (const SweepImage& image : sweep.images) {
    TrackedPicture picture;
    picture.region = region;
    picture.patient_from_pixel = patient_from_pixel(image.sweep_from_probe, geometry);
    picture.time_s = double(pictures.size());
    picture.grey = Image<std::uint8_t>(first.width, first.height);
    for (std::size_t i = 0; i < image.grey.pixels.size(); ++i)
      picture.grey.pixels[i] = std::isnan(image.grey.pixels[i])
                                   ? std::uint8_t(0)
                                   : std::uint8_t(std::clamp(image.grey.pixels[i], 0.0f, 255.0f));
    pictures.push_back(std::move(picture));
  }
  Reconstruction reconstruction(choose_grid(pictures, kVoxel_mm).grid, {});
  for (const TrackedPicture& picture : pictures) reconstruction.add(picture);
  return reconstruction.filled().grey;
}

}  // namespace insonate
