# SPDX-License-Identifier: GPL-3.0-or-later
"""Markdown tables of the experiment `reconstruction`, the paper's figures 5 and 6. Numbers are medians
over the seeds unless a column says otherwise."""

import statistics

from cells import millimetres, percent, results_of, significant, table, verdicts

METHODS = {"air": "in air", "ours": "refracted, our method", "line_search": "with the paper's projection",
           "homography": "with the paper's warp", "papers": "refracted, the paper's method"}
# The methods whose depth maps and completeness are measured, too.
JUDGED = ("air", "ours", "papers")
FEWEST = 5000  # pixels of a ring or kind of place in the tables
# The paper's numbers (its section 4 and the caption of its figure 6): points, mean and variance. Their
# unit is assumed to be metres. The paper registered its clouds to the mesh, so its means are comparable
# to means after a rigid motion.
PAPERS_CLOUDS = {"the paper's own scene, in air": (4200659, 0.88e-3, 2.58e-6),
                 "the paper's own scene, refracted": (4635708, 1.28e-3, 3.72e-6)}


def parts_of(results, poses):
    """The results of the seeds in ascending order. `poses`: "colmap" or "true"."""
    names = sorted(name for name in results["parts"] if name.endswith(f"_{poses}_poses"))
    return [results_of(results, name) for name in names]


def clouds_of(results, poses):
    return [result["clouds"] for result in parts_of(results, poses)]


def maps_of(results):
    return [result["maps"] for result in parts_of(results, "true")]


def median(seeds, value):
    return statistics.median(map(value, seeds))


def each(seeds, value):
    return ", ".join(map(value, seeds))


def beside_air(method, field="mean"):
    return lambda clouds: clouds[method][field] / clouds["air"][field]


def cloud_row(clouds, method):
    middle = lambda field: median(clouds, lambda c: c[method][field])
    ratio = lambda field: f"{median(clouds, beside_air(method, field)):.3f}"
    return [METHODS[method], f"{middle('points'):.0f}", millimetres(middle("mean")),
            millimetres(middle("median")), ratio("mean"),
            each(clouds, lambda c: f"{beside_air(method)(c):.3f}"), percent(middle("recall")),
            significant(1e6 * middle("variance")), ratio("variance")]


def cloud_rows(clouds):
    header = ["cloud", "points", "mean [mm]", "median [mm]", "mean / in air", "of each seed",
              "completeness [%]", "variance [mm²]", "/ in air"]
    return [header] + [cloud_row(clouds, method) for method in METHODS if method in clouds[0]]


def colmap_poses_table(clouds):
    header, *rows = cloud_rows(clouds)
    for method, row in zip(METHODS, rows, strict=True):
        moved = lambda c, name=method: c[name]["moved"]["mean"]
        row += [millimetres(median(clouds, moved)),
                f"{median(clouds, lambda c: moved(c) / c['air']['moved']['mean']):.3f}"]
    _, air_mean, air_variance = next(iter(PAPERS_CLOUDS.values()))
    papers = [[title, str(points), *["-"] * 5, significant(1e6 * variance),
               f"{variance / air_variance:.3f}", millimetres(mean), f"{mean / air_mean:.3f}"]
              for title, (points, mean, variance) in PAPERS_CLOUDS.items()]
    return table([header + ["mean after a rigid move [mm]", "/ in air"], *rows, *papers])


def gains_table(kinds):
    """The change of the mean distance from the paper's method to ours, by projection, warp and both."""
    rows = [("poses", "ours in place of the paper's", "mean distance [%]", "of each seed")]
    changes = (("projection", "papers", "homography"), ("warp", "papers", "line_search"),
               ("warp, after the projection", "homography", "ours"),
               ("projection and warp", "papers", "ours"))
    for poses, clouds in kinds.items():
        for title, before, after in changes:
            if before in clouds[0] and after in clouds[0]:
                gain = lambda c: 100 * (c[after]["mean"] / c[before]["mean"] - 1)
                rows.append((poses, title, f"{median(clouds, gain):+.1f}",
                             each(clouds, lambda c: f"{gain(c):+.1f}")))
    return table(rows)


def completeness_table(clouds):
    cell = lambda method, views: "-" if views not in clouds[0][method]["complete"] else \
        percent(median(clouds, lambda c: c[method]["complete"][views]))
    return table([("seen by at least", *(f"{METHODS[method]} [%]" for method in JUDGED))]
                 + [(f"{views} cameras", *(cell(method, views) for method in JUDGED))
                    for views in "2345"])


def two_table(clouds):
    """Clouds fused with --number-views-fuse 2."""
    rows = [("cloud", "points", "mean [mm]", "mean / in air", "of each seed", "completeness [%]",
             "of each seed")]
    for method in JUDGED:
        value = lambda field: lambda c: c[method]["two"][field]
        ratio = lambda c: c[method]["two"]["mean"] / c["air"]["two"]["mean"]
        rows.append((METHODS[method], f"{median(clouds, value('points')):.0f}",
                     millimetres(median(clouds, value("mean"))), f"{median(clouds, ratio):.3f}",
                     each(clouds, lambda c: f"{ratio(c):.3f}"), percent(median(clouds, value("recall"))),
                     each(clouds, lambda c: percent(value("recall")(c)))))
    return table(rows)


def maps_table(maps):
    rows = [("depth maps", "pixels compared", "median error [mm]", "within 5 mm [%]", "gross errors [%]",
             "mean without them [mm]", "completeness [%]")]
    for method in JUDGED:
        middle = lambda field: median(maps, lambda m: m[method][field])
        rows.append((METHODS[method], f"{middle('pixels'):.0f}", millimetres(middle("median")),
                     percent(middle("within")), percent(middle("gross")), millimetres(middle("mean")),
                     percent(middle("completeness"))))
    return table(rows)


def place_row(places, k, title):
    """`places`: the places of each seed. `k`: the kind of place."""
    middle = lambda value: median(places, lambda p: value(p[k]))
    summed = lambda place: (place["pixels"] - place["gross"]) * place["mean"]
    share = lambda value: median(places, lambda p: value(p[k]) / sum(map(value, p)))
    row = (title, places[0][k]["place"], percent(share(lambda place: place["truths"])))
    if min(p[k]["pixels"] for p in places) < FEWEST:
        return row + ("-",) * 5
    return row + (percent(middle(lambda place: place["pixels"] / max(1, place["truths"]))),
                  millimetres(middle(lambda place: place["median"])),
                  percent(middle(lambda place: place["gross"] / place["pixels"])),
                  millimetres(middle(lambda place: place["mean"])), percent(share(summed)))


def places_table(maps):
    rows = [("depth maps", "pixels with", "of all [%]", "completeness [%]", "median error [mm]",
             "gross errors [%]", "mean without them [mm]", "of the sum without them [%]")]
    for method in JUDGED:
        places = [m[method]["places"] for m in maps]
        rows += [place_row(places, k, METHODS[method]) for k in range(len(places[0]))]
    return table(rows)


def phases_table(maps):
    rows = [("true position within the pixel", *(f"{METHODS[m]} [1/1000 px]" for m in JUDGED))]
    for k, phase in enumerate(maps[0]["air"]["phases"]):
        rows.append((f"{phase['begin']:.3f} to {phase['end']:.3f}",
                     *(f"{1e3 * median(maps, lambda m: m[method]['phases'][k]['shift']):+.1f}"
                       for method in JUDGED)))
    return table(rows)


def ring_differences(maps, method, k):
    """The median error of the method minus that in air, of each seed."""
    return [m[method]["rings"][k]["median"] - m["air"]["rings"][k]["median"] for m in maps]


def counts(maps, k):
    """Whether each seed has enough pixels of each method in ring k."""
    return all(m[method]["rings"][k]["count"] >= FEWEST for m in maps for method in JUDGED)


def rings_table(maps):
    rows = [("ring [half diagonals]", "in air [1e-4]", "ours [1e-4]", "ours - in air", "of each seed",
             "the paper's [1e-4]", "the paper's - in air", "of each seed")]
    scaled = lambda fraction: f"{1e4 * fraction:+.2f}"
    for k, ring in enumerate(maps[0]["air"]["rings"]):
        row = [f"{ring['inner']:.3f} to {ring['outer']:.3f}"]
        if not counts(maps, k):
            rows.append(row + [f"fewer than {FEWEST} pixels"] + ["-"] * 6)
            continue
        middle = lambda method: scaled(median(maps, lambda m: m[method]["rings"][k]["median"]))
        row.append(middle("air"))
        for method in ("ours", "papers"):
            differences = ring_differences(maps, method, k)
            row += [middle(method), scaled(statistics.median(differences)), each(differences, scaled)]
        rows.append(row)
    return table(rows)


def largest_ring_difference(maps):
    """The largest |median over the seeds of our method's difference from air| of the rings that count."""
    return max((abs(statistics.median(ring_differences(maps, "ours", k)))
                for k in range(len(maps[0]["air"]["rings"])) if counts(maps, k)), default=0)


def requirements(clouds, maps):
    ratio = median(clouds, beside_air("ours"))
    trend = largest_ring_difference(maps)
    more = lambda value: median(clouds, lambda c: value(c["ours"]) - value(c["air"]))
    points = lambda asked, value: (asked, f"{100 * value:+.1f} percentage points", value >= 0)
    return verdicts(
        ("our method, COLMAP's poses: mean / in air at most 0.95", f"{ratio:.3f}", ratio <= 0.95),
        points("the same: completeness, of what two cameras see, no lower than in air",
               more(lambda cloud: cloud["complete"]["2"])),
        points("the same, of what three cameras see", more(lambda cloud: cloud["complete"]["3"])),
        points("the same, of what two cameras see, where both clouds want two views "
               "(--number-views-fuse 2)", more(lambda cloud: cloud["two"]["recall"])),
        ("our method, true poses: every ring within 1e-4 of in air", f"{1e4 * trend:.2f}e-4",
         trend <= 1e-4))


def reconstruction(results):
    on_colmaps, on_true, maps = (clouds_of(results, "colmap"), clouds_of(results, "true"),
                                 maps_of(results))
    registered = [("seed", "images registered by COLMAP", "their centres' RMS [mm]")]
    for name, part in results["parts"].items():
        if name.endswith("_colmap_poses"):
            registered.append((name.split("_")[0].removeprefix("seed"), str(part["result"]["images"]),
                               millimetres(part["result"]["centre_rms"])))
    return {"reconstruction.md": colmap_poses_table(on_colmaps),
            "reconstruction_complete.md": completeness_table(on_colmaps),
            "reconstruction_two.md": two_table(on_colmaps),
            "reconstruction_poses.md": table(registered),
            "reconstruction_true.md": table(cloud_rows(on_true)),
            "reconstruction_gains.md": gains_table({"COLMAP's": on_colmaps, "true": on_true}),
            "reconstruction_maps.md": maps_table(maps),
            "reconstruction_rings.md": rings_table(maps),
            "reconstruction_places.md": places_table(maps),
            "reconstruction_phases.md": phases_table(maps),
            "reconstruction_verdicts.md": requirements(on_colmaps, maps)}
