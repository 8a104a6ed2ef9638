#include "scenarios/report/report.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "scenarios/report/charts.h"
#include "scenarios/report/embedded_files.h"
#include "scenarios/report/path.h"
#include "scenarios/words.h"

namespace insonate {
namespace {

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string outcome_chip(StepOutcome outcome) {
  return "<span class='outcome " + std::string(is_done(outcome) ? "good" : "bad") + "'>" + in_words(outcome) +
         "</span>";
}

std::string bar(double share) {
  return std::string("<div class='bar") + (share >= 1 ? " all" : "") + "'><i style='width:" + fixed(100 * share, 1) +
         "%'></i></div>";
}

std::string row(const CriterionScore& m) {
  const double share = m.weight > 0 ? m.points / m.weight : 0;
  const char* grade = share >= 1 ? "all" : share > 0 ? "some" : "none";
  std::string html = "<tr class='" + std::string(grade) + "'><td><b>" + escaped(title_of(m.metric)) + "</b>";
  if (m.critical) html += " <span class='critical' title='" + std::string(kCriticalMeans) + "'>critical</span>";
  html += "<small>" + escaped(unbroken(m.why)) + "</small></td>";
  html += "<td class='number'>" + (m.value ? in_words(m.metric, *m.value) : "\u2013") + "</td>";
  html += "<td class='number'>" + in_words(m.metric, m.full) + " \u2026 " + in_words(m.metric, m.zero) + "</td>";
  html +=
      "<td class='number'>" + short_number(m.points) + " of " + short_number(m.weight) + bar(share) + "</td></tr>\n";
  return html;
}

std::string table(const std::vector<CriterionScore>& criteria) {
  if (criteria.empty()) return "<p class='quiet'>This part does not count.</p>";
  std::string html =
      "<table class='marks'><thead><tr><th>Criterion</th><th class='number'>Value</th><th class='number'>All \u2026 "
      "no points</th>"
      "<th class='number'>Points</th></tr></thead><tbody>\n";
  for (const CriterionScore& m : criteria) html += row(m);
  return html + "</tbody></table>";
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t j = 0; j < 3; ++j)
      group = group << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0u);
    for (std::size_t j = 0; j < 4; ++j) text += i + j <= bytes.size() ? kDigits[group >> (18 - 6 * j) & 63u] : '=';
  }
  return text;
}

/// The learner's picture on the left, the reference picture on the right.
std::string pictures_of(const StepResult& step, std::size_t index, const std::vector<ReportPicture>& pictures) {
  struct Place {
    ReportPicture::Kind kind;
    const char* caption;
    std::string missing;  ///< in place of the picture; empty if nothing takes its place
    const char* caption_of_missing;
  };
  std::string html;
  bool any = false;
  const bool holds = step.value(Metric::longest_hold_s).has_value(), held = step.outcome == StepOutcome::held;
  for (const Place& place :
       {Place{ReportPicture::Kind::best, held ? "While the view was held best" : "The learner's picture",
              holds ? "The view was not held" : "No picture", "The learner's picture"},
        Place{ReportPicture::Kind::reference, "Reference view", "", ""}}) {
    const ReportPicture* shown = nullptr;
    for (const ReportPicture& picture : pictures)
      if (picture.step == index && picture.kind == place.kind) shown = &picture;
    if (!shown && place.missing.empty()) continue;
    html += "<figure>";
    html += shown ? "<img alt='' src='data:image/png;base64," + base64(shown->png) + "'>"
                  : "<div class='missing'>" + place.missing + "</div>";
    html += "<figcaption>" + std::string(shown ? place.caption : place.caption_of_missing) + "</figcaption></figure>";
    any = any || shown;
  }
  return any ? "<div class='pictures'>" + html + "</div>" : "";
}

/// Describes help that costs no points, because a person who compares attempts has to know of it.
std::string guide_in_words(const StepResult& step) {
  return "The guide to the view was shown " +
         (step.guide_times == 1 ? std::string("once") : std::to_string(step.guide_times) + " times") + ", for " +
         fixed(step.guide_s, 1) + " s of " + fixed(step.end_s - step.start_s, 1) + " s.";
}

/// Returns which picture was judged. Kinds of steps that hold no view judge one moment, such as a frozen picture.
std::string judged_in_words(const StepResult& step) {
  if (!step.judged_from_s) return "";
  const std::string from = fixed(*step.judged_from_s, 1) + " s";
  if (!step.value(Metric::longest_hold_s)) return "The picture at " + from + " was judged.";
  return std::string(step.outcome == StepOutcome::held ? "Judged over the hold" : "Never held long enough: judged") +
         " from " + from + " to " + fixed(*step.judged_to_s, 1) + " s.";
}

/// Returns what the step found besides values, a line each.
std::string facts_of(const StepResult& step) {
  if (step.facts.empty()) return "";
  std::string rows;
  for (const auto& [what, fact] : step.facts)
    rows += "<tr><td>" + escaped(title_of_fact(what, fact)) + "</td><td>" + escaped(unbroken(fact)) + "</td></tr>\n";
  return "<table class='facts'>" + rows + "</table>";
}

std::string section(const StepResult& step, std::size_t index, const std::vector<ReportPicture>& pictures) {
  std::string html =
      "<section><h2>" + std::to_string(index + 1) + ". " + escaped(step.title) + outcome_chip(step.outcome) + "</h2>";
  if (step.outcome == StepOutcome::skipped) return html + "</section>\n";
  if (step.outcome != StepOutcome::not_reached) {
    html += "<p class='quiet'>From " + fixed(step.start_s, 1) + " s to " + fixed(step.end_s, 1) + " s. ";
    html += judged_in_words(step) + "</p>";
  }
  if (!step.counts) html += "<p class='quiet'>A warm-up, which does not count.</p>";
  if (step.hints_taken > 0)
    html += "<p class='quiet'>Hints taken: " + std::to_string(step.hints_taken) + ", for " +
            short_number(step.lost_to_hints()) + " points.</p>";
  if (step.guide_times > 0) html += "<p class='quiet'>" + guide_in_words(step) + "</p>";
  return html + facts_of(step) + table(step.criteria) + pictures_of(step, index, pictures) + "</section>\n";
}

/// One line per step, as a summary for the examiner.
std::string overview(const ExamResult& result) {
  const auto line = [](const std::string& name, const std::string& outcome, double time_s, const StepResult& scored,
                       const std::string& score) {
    const double possible = scored.possible();
    return "<tr><td>" + name + "</td><td>" + outcome + "</td><td class='number'>" + fixed(time_s, 1) +
           " s</td><td class='number'>" + score + (possible > 0 ? bar(scored.earned() / possible) : "") +
           "</td></tr>\n";
  };
  std::string html = "<table class='overview'><tbody>\n";
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    const StepResult& step = result.steps[i];
    html += line(std::to_string(i + 1) + ". " + escaped(step.title), outcome_chip(step.outcome),
                 step.end_s - step.start_s, step, score_in_words(step));
  }
  StepResult whole;  // its criteria are those of a step that has no other properties
  whole.outcome = StepOutcome::done;
  whole.criteria = result.criteria;
  // Without criteria the whole has only its time.
  return html +
         line("Whole exam", "", result.motion.time_s, whole, whole.criteria.empty() ? "" : score_in_words(whole)) +
         "</tbody></table>";
}

std::string verdict(const ExamResult& result) {
  const char* state = !result.complete ? "open" : result.passed ? "passed" : "failed";
  const char* word = !result.complete ? "Not finished" : result.passed ? "Passed" : "Not passed";
  std::string html = "<div class='verdict " + std::string(state) + "'><div><strong>" + word +
                     "</strong><span class='percent'>" + percentage(result) + "<small> %</small></span></div>";
  html += "<div class='meter'><i style='width:" + fixed(result.percent, 1) +
          "%'></i><b style='left:" + fixed(result.pass_mark_percent, 1) + "%'></b></div>";
  html += "<p>" + short_number(result.points) + " of " + short_number(result.points_possible) + " points; " +
          short_number(result.pass_mark_percent) + " % are needed.</p>";
  const auto any_critical = [](const auto& scored) {
    return std::ranges::any_of(scored.criteria, [](const CriterionScore& mark) { return mark.critical; });
  };
  if (any_critical(result) || std::ranges::any_of(result.steps, any_critical))
    html += "<p>" + std::string(kCriticalMeans) + "</p>";
  const auto guided = std::ranges::count_if(result.steps, [](const StepResult& s) { return s.guide_times > 0; });
  if (guided > 0)
    html += "<p>The guide to the view was used in " + std::to_string(guided) + " of " +
            std::to_string(result.steps.size()) + " steps.</p>";
  if (!result.reasons.empty()) {
    html += "<ul>";
    for (const std::string& reason : result.reasons) html += "<li>" + escaped(unbroken(reason)) + "</li>";
    html += "</ul>";
  }
  return html + overview(result) + "</div>\n";
}

/// Returns the kind of attempt. Readers need it before they compare reports.
std::string kind_of_report(std::optional<AttemptMode> mode) {
  if (!mode) return "Score report";
  switch (*mode) {
    case AttemptMode::exam:
      return "Score report of an exam";
    case AttemptMode::practice:
      return "Score report of practice, which does not count as an exam";
    case AttemptMode::recording:
      return "Score report of a recorded scan";
  }
  return "";
}

std::string whose(const ReportSubject& subject) {
  std::string rows;
  for (const auto& [name, value] : {std::pair{"Learner", &subject.learner},
                                    {"No. in the results", &subject.attempt},
                                    {"Finished", &subject.finished}})
    if (!value->empty())
      rows.append("<tr><td>").append(name).append("</td><td>").append(escaped(*value)) += "</td></tr>";
  return rows.empty() ? "" : "<table class='whose'>" + rows + "</table>";
}

std::string comments_section(const std::vector<ReportComment>& comments) {
  if (comments.empty()) return "";
  std::string html = "<section class='comments'><h2>Comments</h2>\n";
  for (const ReportComment& comment : comments)
    html += "<p>" + escaped(comment.text) + "<small>" +
            escaped(comment.author.empty() ? comment.written : comment.author + ", " + comment.written) +
            "</small></p>\n";
  return html + "</section>\n";
}

std::string made_from(const ExamResult& result) {
  const Provenance& p = result.provenance;
  const auto line = [](const char* name, const std::string& value, const std::string& digest = {}) {
    if (value.empty()) return std::string();
    return "<tr><td>" + std::string(name) + "</td><td>" + escaped(value) +
           (digest.empty() ? "" : " <code>" + escaped(digest) + "</code>") + "</td></tr>";
  };
  std::string options;
  for (const auto& [name, value] : p.phantom_options)
    options.append(options.empty() ? "" : ", ").append(name).append(" = ").append(value);
  return "<section class='origin'><h2>Made from</h2><table>" + line("Scenario", p.scenario, p.scenario_digest) +
         line("Case", p.case_name, p.case_digest) + line("Phantom options", options) +
         line("Variant", p.variant.empty() ? "" : p.variant + ", drawn by seed " + std::to_string(p.seed)) +
         line("Log", p.log, p.log_digest) + line("Transform", p.log_transform) +
         line("Insonate", p.program_version + ", scoring " + std::to_string(p.scoring_version)) +
         "</table></section>\n";
}

}  // namespace

std::string report_html(const ExamResult& result, std::span<const TracePoint> trace, const ReportSubject& subject) {
  std::string html =
      "<!doctype html>\n<html lang='en'><head><meta charset='utf-8'>"
      "<meta name='viewport' content='width=device-width, initial-scale=1'><title>" +
      escaped(result.title) + "</title><style>\n" + std::string(report_file("report.css")) +
      "</style></head>\n<body><main>\n";
  html += "<header><div><p class='quiet'>" + kind_of_report(result.provenance.mode) + "</p><h1>" +
          escaped(result.title) + "</h1><p class='quiet'>" + escaped(result.provenance.case_name) + "</p></div>" +
          whose(subject) + "</header>\n";
  if (!result.briefing.empty()) html += "<p class='briefing'>" + escaped(result.briefing) + "</p>\n";
  html += verdict(result) + comments_section(subject.comments);
  for (std::size_t i = 0; i < result.steps.size(); ++i) html += section(result.steps[i], i, subject.pictures);
  if (!result.criteria.empty()) html += "<section><h2>Whole exam</h2>" + table(result.criteria) + "</section>\n";
  if (!trace.empty()) {
    html += "<section><h2>Over time</h2>" + time_charts_svg(result, trace) +
            "<p class='legend'><i class='key held'></i>view held or step done <i class='key judged'></i>judged, not "
            "held or done <i class='key lost'></i>no tracking <i class='key full'></i>full points. The curves compare "
            "with the plane that each step is judged in, also while a step measures in another.</p></section>\n";
    html += "<section><h2>Path of the probe</h2>" + path_html(result, trace) + "<p class='legend'>";
    for (std::size_t i = 0; i < result.steps.size(); ++i)
      html += "<i class='key path" + std::to_string(i % 4) + "'></i>" + escaped(result.steps[i].title) + " ";
    html +=
        "<i class='key spot good'></i>view held or step done <i class='key spot bad'></i>judged, not "
        "held or done</p></section>\n";
  }
  return html + made_from(result) + "</main></body></html>\n";
}

}  // namespace insonate
