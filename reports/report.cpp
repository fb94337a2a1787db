#include "reports/report.h"

#include "core/files.h"
#include "reports/contact_sheet.h"
#include "reports/page.h"

namespace tarmac::reports {

void write_report(const std::filesystem::path& html_file, const ReportInput& input, const core::Progress& progress) {
  const Pictures pictures = draw_pictures(input, progress);
  if (progress) progress(0.95, "writing the page");
  core::write_file(html_file, assemble_page(input, pictures));
  if (progress) progress(1, html_file.filename().string());
}

void render_scene(const std::filesystem::path& file, const scenes::Scene& scene, core::Time t, int width_px,
                  int height_px, const std::optional<EyeView>& from) {
  Stills stills(scene, t);
  write_picture(file, from ? stills.seen_from(*from, width_px, height_px) : stills.overview(width_px, height_px));
}

}  // namespace tarmac::reports
