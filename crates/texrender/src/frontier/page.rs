//! The report as one page of HTML that needs nothing else.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::charts::{Chart, label, peer_names};
use super::crops::{CropSet, FULL_SCALE_ERROR, Picture};
use super::family::Family;
use super::measure::{KERNELS, Sheet};
use super::plot::LEAST_ERROR;
use super::{Frontier, GAUSSIAN_CUT};

const STYLE: &str = include_str!("page.css");

/// The page for `frontier`, made by `command`.
pub(super) fn html(frontier: &Frontier, command: &str) -> String {
    let sections = [
        introduction(frontier, command),
        plots(frontier),
        tables(frontier),
        rivals(frontier),
        crops(frontier),
    ];
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Texture filters: speed against error</title>\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n{}</body>\n</html>\n",
        sections.concat()
    )
}

fn introduction(frontier: &Frontier, command: &str) -> String {
    let [few, some, many] = frontier.effort.samples.per_pixel();
    let mut links = String::new();
    for sheet in &frontier.sheets {
        push(
            &mut links,
            format_args!(
                "<li><a href=\"#{}\">{}</a></li>",
                sheet.stem(),
                sheet.title()
            ),
        );
    }
    format!(
        "<header>\n<h1>Texture filters: speed against error</h1>\n\
         <p class=\"lead\">How long each filter takes for a pixel, and how far its colour is from what that pixel \
         ought to show.</p>\n</header>\n\
         <nav aria-label=\"Scenes\"><ul>{links}<li><a href=\"#table\">Table</a></li>\
         <li><a href=\"#crops\">Pictures</a></li></ul></nav>\n\
         <h2 id=\"read\">How to read it</h2>\n\
         <p>Every scene is a textured plane. For each pixel the right colour is worked out from many points within \
         it, in 64-bit arithmetic, by code that shares nothing with the filters. A filter’s error is its colour less \
         that one, on a scale where black is 0 and white is 1.</p>\n\
         <p>In the plots, <b>left is faster and down is better</b>. Filters on the line are the Pareto front: none \
         is both faster and better. Filled points are on it, hollow ones are not. Errors under {LEAST_ERROR} \
         are drawn at {LEAST_ERROR}.</p>\n{legend}\
         <p>What a pixel ought to show depends on its <b>kernel</b>: how much each point near the pixel counts. Kernels \
         differ by more than good filters err, so each filter is held against three.</p>\n{kernels}\
         <h3>How it was measured</h3>\n<ul>\n\
         <li>Made by <code>{command}</code>.</li>\n\
         <li>References: {few}, {some} or {many} samples a pixel, one in each cell of a grid, for footprints under 8, \
         under 64, and from 64 texels in length. The noise stated with each scene is an upper bound, the RMS of half \
         the difference between two halves of the samples; differences of its size mean little.</li>\n\
         <li>Errors are taken over a lattice of the frame’s pixels, stated with each scene, and over the texture’s own channels, before \
         rounding to 8 bits.</li>\n\
         <li>Time a lookup: one thread, consecutive pixels of rows spread over the frame, footprints ready, the best of \
         {passes} passes over all filters. Time a frame: {threads} threads; clear, footprint of each pixel, lookup, \
         store; the median of up to {frames} frames, fewer for slow filters, of which rows are left out where a frame \
         would take over {longest} s, and the time multiplied. Both are taken with a scene’s first texture \
         of a size and hold for the others, since no filter looks at what a texel is.</li>\n\
         <li>Textures are 8-bit RGBA, linear, repeated; coarser levels by the box.</li>\n</ul>\n",
        legend = legend(frontier),
        kernels = kernels(),
        command = escape(command),
        passes = frontier.effort.timing.passes,
        threads = frontier.threads,
        frames = frontier.effort.timing.frames,
        longest = frontier.effort.timing.longest_frame_seconds,
    )
}

fn legend(frontier: &Frontier) -> String {
    let mut items = String::new();
    let mut item = |family: Family, name: &str, class: &str| {
        let colour = family.colour();
        let (r, g, b) = (colour.0, colour.1, colour.2);
        push(
            &mut items,
            format_args!(
                "<li><i{class} style=\"background:rgb({r},{g},{b})\"></i>{}</li>",
                escape(name)
            ),
        );
    };
    for (family, name) in Family::NAMED {
        let is_shown = |sheet: &Sheet| {
            sheet
                .rows
                .iter()
                .any(|row| Family::of(&row.filter) == family)
        };
        if frontier.sheets.iter().any(is_shown) {
            item(family, name, "");
        }
    }
    for (number, name) in peer_names(&frontier.peers).into_iter().enumerate() {
        item(Family::Peer(number), name, " class=\"peer\"");
    }
    format!("<ul class=\"legend\">{items}</ul>\n")
}

fn kernels() -> String {
    format!(
        "<dl>\n<dt>box</dt><dd>The pixel’s unit square, every point alike. What anti-aliased renderers usually \
         mean.</dd>\n\
         <dt>gaussian</dt><dd>A Gaussian about the pixel’s centre, σ = ½ pixel, cut at {GAUSSIAN_CUT}σ in x and in y. \
         Softer than the box: it takes in neighbours.</dd>\n\
         <dt>own</dt><dd>What the filter says it approximates. <b>Point</b>: the texture between its texels at the \
         pixel’s centre. <b>Square</b>: a square along the texture’s axes, as wide as the footprint is long. <b>Axes</b>: \
         the rectangle that the footprint ellipse’s two axes span. <b>Bounds</b>: the upright rectangle with sides \
         hypot(∂s/∂x, ∂s/∂y) and hypot(∂t/∂x, ∂t/∂y). <b>Parallelogram</b> and <b>ellipse</b>: \
         the square and the Gaussian pixel, the plane taken as parallel to the screen around it. This error says how well a filter is \
         made, not how good it looks.</dd>\n</dl>\n"
    )
}

fn plots(frontier: &Frontier) -> String {
    let mut text = String::new();
    for sheet in &frontier.sheets {
        let noise: Vec<String> = sheet
            .noise
            .iter()
            .map(|(kernel, noise)| format!("{} {noise:.4}", kernel.name()))
            .collect();
        push(
            &mut text,
            format_args!(
                "<h2 id=\"{}\">{}</h2>\n<p>{}. <span class=\"quiet\">{}×{} pixels; errors against the \
                 box at {} of them, against the others at {}; noise of the \
                 references: {}.</span></p>\n",
                sheet.stem(),
                sheet.title(),
                sentence(sheet.scene.about),
                sheet.scene.size.x,
                sheet.scene.size.y,
                sheet.pixels[0],
                sheet.pixels[1],
                noise.join(", "),
            ),
        );
        let charts = sheet.charts();
        let [against_box, others @ ..] = charts.as_slice() else {
            continue;
        };
        text += &figure(against_box);
        if let Some(chart) = sheet.peers_chart(&frontier.peers, frontier.threads) {
            text += &figure(&chart);
        }
        text += "<details><summary>Against a Gaussian pixel, and against each filter’s own kernel</summary>\n";
        for chart in others {
            text += &figure(chart);
        }
        text += "</details>\n";
    }
    text
}

fn figure(chart: &Chart) -> String {
    let svg = chart.plot.to_svg();
    // A role and a name for readers that do not see it.
    let named = svg.replacen(
        "<svg ",
        &format!(
            "<svg role=\"img\" aria-label=\"{}\" ",
            escape(&chart.plot.title)
        ),
        1,
    );
    format!("<figure class=\"plot\">{named}</figure>\n")
}

fn tables(frontier: &Frontier) -> String {
    let mut text = "<h2 id=\"table\">Table</h2>\n<p>RMSE, largest error and mean error (positive is too bright) \
                    against each kernel. <b>●</b> marks the Pareto front of time a lookup.</p>\n"
        .to_owned();
    for sheet in &frontier.sheets {
        push(
            &mut text,
            format_args!("<h3>{}</h3>\n{}", sheet.title(), table(sheet)),
        );
    }
    text
}

fn table(sheet: &Sheet) -> String {
    let mut heads = String::new();
    let mut columns = String::new();
    for kernel in KERNELS {
        push(
            &mut heads,
            format_args!("<th class=\"first\" colspan=\"3\">{kernel}</th>"),
        );
        columns += "<th class=\"first\">RMSE</th><th>max</th><th>mean</th>";
    }
    let by_kernel = KERNELS.map(|kernel| (sheet.rows_against(kernel), sheet.front(kernel)));
    let mut body = String::new();
    for (k, row) in by_kernel[0].0.iter().enumerate() {
        push(
            &mut body,
            format_args!(
                "<tr><td class=\"name\">{}</td><td class=\"name\">{}</td><td class=\"name\">{}</td>\
                 <td>{:.1}</td><td>{:.2}</td>",
                escape(&row.filter),
                escape(&row.setting),
                sheet.own[k].name(),
                row.ns_per_lookup,
                row.ms_per_frame
            ),
        );
        for (rows, front) in &by_kernel {
            let errors = rows[k].errors;
            let class = if front.contains(&k) {
                "first front"
            } else {
                "first"
            };
            push(
                &mut body,
                format_args!(
                    "<td class=\"{class}\">{:.4}</td><td>{:.3}</td><td>{:+.4}</td>",
                    errors.rmse, errors.max, errors.mean
                ),
            );
        }
        body += "</tr>\n";
    }
    format!(
        "<div class=\"wide\"><table>\n<thead><tr><th class=\"name\" rowspan=\"2\">filter</th>\
         <th class=\"name\" rowspan=\"2\">setting</th><th class=\"name\" rowspan=\"2\">own kernel</th>\
         <th rowspan=\"2\">ns a lookup</th><th rowspan=\"2\">ms a frame</th>{heads}</tr>\n<tr>{columns}</tr></thead>\n\
         <tbody>\n{body}</tbody></table></div>\n"
    )
}

/// Ours beside peers of the same name.
fn rivals(frontier: &Frontier) -> String {
    let mut text = String::new();
    for sheet in &frontier.sheets {
        let rivals = sheet.rivals(&frontier.peers, frontier.threads);
        if rivals.is_empty() {
            continue;
        }
        let mut body = String::new();
        for rival in rivals {
            let ours = rival.ours;
            let time_ratio = ours.ms_per_frame / rival.peer.milliseconds;
            let [theirs, error_ratio] = match rival.peer.rmse {
                Some(rmse) => [
                    format!("<td>{rmse:.4}</td>"),
                    ratio(ours.errors.rmse / rmse),
                ],
                None => ["<td>–</td>", "<td>–</td>"].map(str::to_owned),
            };
            push(
                &mut body,
                format_args!(
                    "<tr><td class=\"name\">{}</td><td class=\"name\">{}</td><td class=\"first\">{:.4}</td>{theirs}\
                     {error_ratio}<td class=\"first\">{:.2}</td><td>{:.2}</td>{}</tr>\n",
                    escape(&label(&ours.filter, &ours.setting)),
                    escape(&rival.peer.peer),
                    ours.errors.rmse,
                    ours.ms_per_frame,
                    rival.peer.milliseconds,
                    ratio(time_ratio)
                ),
            );
        }
        push(
            &mut text,
            format_args!(
                "<h3>{}</h3>\n<div class=\"wide\"><table>\n<thead><tr><th class=\"name\">filter</th>\
                 <th class=\"name\">peer</th><th class=\"first\">our RMSE</th><th>its RMSE</th><th>ratio</th>\
                 <th class=\"first\">our ms</th><th>its ms</th><th>ratio</th></tr></thead>\n\
                 <tbody>\n{body}</tbody></table></div>\n",
                sheet.title()
            ),
        );
    }
    if text.is_empty() {
        return text;
    }
    format!(
        "<h2 id=\"peers\">Beside other renderers</h2>\n<p>The same filter on the same scene, a frame on {} threads, \
         error against a box pixel. A ratio above 1 says that the other renderer is better. Its times are those of \
         the file given, from another moment of whatever machine it was made on.</p>\n{text}",
        frontier.threads
    )
}

fn ratio(ratio: f64) -> String {
    let class = if ratio > 1.005 {
        " class=\"worse\""
    } else {
        ""
    };
    format!("<td{class}>{ratio:.2}</td>")
}

fn crops(frontier: &Frontier) -> String {
    if frontier.sheets.iter().all(|sheet| sheet.crops.is_empty()) {
        return String::new();
    }
    let mut text = format!(
        "<h2 id=\"crops\">Pictures</h2>\n<p>Parts of the frames, twice as large as drawn. Below each its error against \
         the box pixel: red is too bright, blue too dark, full colour from {FULL_SCALE_ERROR}. The number is the RMSE \
         within the picture.</p>\n"
    );
    for (number, sheet) in frontier.sheets.iter().enumerate() {
        for (k, set) in sheet.crops.iter().enumerate() {
            // The first stands open, as an example.
            let open = if number == 0 && k == 0 { " open" } else { "" };
            push(
                &mut text,
                format_args!(
                    "<details{open}><summary>{}, {}</summary>\n{}</details>\n",
                    sheet.title(),
                    set.crop.name,
                    crop_set(set)
                ),
            );
        }
    }
    text
}

fn crop_set(set: &CropSet) -> String {
    let mut text = format!(
        "<div class=\"crops\">\n<figure><figcaption><b>reference</b><span>box pixel</span></figcaption>{}</figure>\n",
        image(&set.reference, "reference")
    );
    for crop in &set.filters {
        let name = escape(&label(&crop.filter, &crop.setting));
        push(
            &mut text,
            format_args!(
                "<figure><figcaption><b>{name}</b><span>{:.4}</span></figcaption>{}{}</figure>\n",
                crop.rmse,
                image(&crop.picture, &name),
                image(&crop.error, &format!("error of {name}")),
            ),
        );
    }
    text + "</div>\n"
}

fn image(picture: &Picture, alt: &str) -> String {
    format!(
        "<img alt=\"{alt}\" width=\"{}\" height=\"{}\" src=\"data:image/png;base64,{}\">",
        picture.size.x,
        picture.size.y,
        STANDARD.encode(picture.to_png())
    )
}

/// The text with its first letter large.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

fn push(text: &mut String, what: std::fmt::Arguments<'_>) {
    text.write_fmt(what)
        .expect("writing to a string does not fail");
}
