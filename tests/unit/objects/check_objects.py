#!/usr/bin/env python3
"""Checks the table of much pictured objects (assets/objects/objects.csv) by itself and, where Stellarium's catalogue is
given, against that: kind, place, size, angle and distance. Nothing is written but what differs.

    python3 check_objects.py assets/objects/objects.csv
    python3 check_objects.py assets/objects/objects.csv catalog.dat

The catalogue is not kept here. Debian's package has it, and need not be installed (250 MB):

    apt-get download stellarium-data && dpkg-deb -x stellarium-data_*.deb out
    out/usr/share/stellarium/nebulae/default/catalog.dat

Stellarium's source has the same rows as text, nebulae/default/catalog.txt, which is read too.
Exit code: 0 when all is well, 1 when something is wrong or differs without standing in the list EXPLAINED."""
import csv
import gzip
import math
import re
import struct
import sys

COLUMNS = ["names", "kind", "right_ascension_deg", "declination_deg", "major_arcmin", "minor_arcmin",
           "position_angle_deg", "inclination_deg", "distance_ly", "source"]
DISKS = {"spiral", "barred", "lenticular", "irregular"}
GALAXIES = DISKS | {"elliptical", "interacting", "galaxy_group", "galaxy_cluster"}
KINDS = GALAXIES | {"deep_field", "open_cluster", "globular_cluster", "planetary", "remnant", "emission", "reflection",
                    "dark", "star", "other"}
LIGHT_YEARS_PER_KILOPARSEC = 3261.56

# What may be said of an object of each of Stellarium's types. Types are numbered in catalog.dat in this order.
TYPES = ["G", "GX", "RG", "IG", "QSO", "CL", "OC", "GC", "SA", "SC", "NB", "PN", "DN", "RN", "BN", "EN", "C+N", "HII",
         "SNR", "ISM", "EMO", "BLL", "BLA", "MOC", "YSO", "Q?", "PN?", "PPN", "*", "SS", "EL*", "SNC", "SNR?", "CGG",
         "PART", "REG", ""]
NEBULAE = {"emission", "reflection", "remnant", "planetary", "dark", "star"}
CLASSES = {
    **dict.fromkeys(["G", "GX", "AGX", "RG", "IG", "QSO", "BLL", "BLA"], GALAXIES),
    "CGG": {"galaxy_group", "galaxy_cluster"},
    "OC": {"open_cluster"}, "GC": {"globular_cluster"}, "SA": {"open_cluster", "emission"}, "SC": {"open_cluster"},
    "CL": {"open_cluster", "globular_cluster", "emission"},
    "NB": NEBULAE, "BN": NEBULAE, "ISM": NEBULAE, "EMO": NEBULAE, "MOC": {"dark", "emission", "reflection"},
    "PN": {"planetary"}, "PN?": {"planetary"}, "PPN": {"planetary"}, "DN": {"dark"}, "RN": {"reflection"},
    "EN": {"emission"}, "HII": {"emission"}, "HA": {"emission"},
    "C+N": {"emission", "reflection", "open_cluster"},
    "SNR": {"remnant"}, "SNC": {"remnant"}, "SNR?": {"remnant"}, "*": {"star"},
}

# The catalogue's columns of numbers, and how a name of the table begins that has one of them; most telling ones first.
NUMBERS = ("NGC", "IC", "M", "C", "B", "Sh2", "VdB", "RCW", "LDN", "LBN", "Cr", "Mel", "PGC", "UGC")
PREFIXES = {"m": "M", "ngc": "NGC", "ic": "IC", "c": "C", "barnard": "B", "sh2-": "Sh2", "ugc": "UGC", "pgc": "PGC",
            "rcw": "RCW", "melotte": "Mel", "arp": "Arp"}

# Differences that were looked at, by the reason why the table stays as it is: the row's first name and what differs.
EXPLAINED = {
    "Stellarium has the whole region, the row what pictures show of it":
        "M 16 size; NGC 6992 size; NGC 6960 size; NGC 6729 size; IC 349 size; NGC 2024 size; NGC 6334 size; "
        "NGC 3576 size; Westerlund 2 size",
    "Stellarium has the cluster, star or brightest part, the row the whole nebula":
        "NGC 2264 kind, size; IC 1848 kind, size; IC 1396 size; NGC 6357 size, place, name; IC 2177 kind, size; "
        "NGC 7822 size, place; NGC 3603 size; NGC 7129 size; Sh2-308 kind; Barnard 72 size",
    "a planetary nebula with its faint lobes, or without its faint halo":
        "M 57 size; NGC 6537 size; IC 4406 size; NGC 2440 size",
    "Stellarium has one galaxy of several, or one piece of the whole":
        "Stephan's Quintet size; Leo Triplet size; NGC 4656 size, angle; Arp 273 size; NGC 2207 angle; Pipe Nebula place",
    "the size at 25 magnitudes is larger than Stellarium's, which leaves out faint arms, shells or tails":
        "M 95 size; NGC 1365 size; NGC 1512 size; NGC 1316 size; NGC 2685 size; NGC 4438 size; NGC 2623 size; UGC 10214 size",
    "other catalogues have OpenNGC's size": "NGC 3256 size; NGC 7006 size; NGC 4372 size",
    "Stellarium's angle is that of a box, a bar or the inner part, and not of the outline in pictures":
        "M 1 angle; M 33 angle; M 96 angle; M 109 angle; NGC 4236 angle; NGC 147 angle; NGC 1512 angle",
    "Stellarium's type is not that of pictures: arms, a disk with dust, a disk without arms":
        "NGC 3370 shape; NGC 1316 shape; IC 335 shape",
    "OpenNGC's place is the bright part's": "IC 1795 place, name; NGC 6188 place",
    "a filament of the Vela remnant": "NGC 2736 kind",
    "dust lit by the star Rho Ophiuchi": "IC 4604 kind",
    "stars form there; no supernova is known": "NGC 6334 kind",
    "stars' brightness (Cepheids, tip of the red giants) or the cluster it belongs to says nearer or farther":
        "M 98 distance; NGC 7814 distance; NGC 2841 distance; NGC 4522 distance; NGC 6217 distance; NGC 4945 distance; "
        "NGC 4697 distance; NGC 2683 distance; NGC 4414 distance; NGC 4535 distance; IC 1613 distance; "
        "NGC 6822 distance; NGC 1569 distance",
    "parallaxes of its stars say nearer or farther":
        "M 29 distance; M 48 distance; M 52 distance; NGC 559 distance; NGC 663 distance; NGC 457 distance; "
        "IC 5146 distance; NGC 6992 distance; NGC 6960 distance; NGC 2244 distance; NGC 2360 distance; "
        "NGC 3132 distance; NGC 4755 distance; NGC 2264 distance; IC 1396 distance; IC 1805 distance; "
        "IC 1848 distance; NGC 281 distance; NGC 6334 distance; NGC 6357 distance; IC 2177 distance; "
        "NGC 1333 distance; NGC 2467 distance; NGC 6164 distance; NGC 1514 distance; NGC 3576 distance",
    "distances in books differ by more than a factor of two": "IC 4406 distance; NGC 5189 distance",
}


def reasons():
    """EXPLAINED the other way round: (first name, what): reason."""
    pairs = {}
    for reason, text in EXPLAINED.items():
        for group in text.split("; "):
            name, first, rest = re.fullmatch(r"(.+?) (\w+)((?:, \w+)*)", group).groups()
            pairs.update({(name, what): reason for what in [first, *rest.split(", ")[1:]]})
    return pairs


def key_of(name):
    return "".join(name.split()).casefold()


def number(text, line, column, low, high, problems, may_be_empty=True):
    """The number in a cell, or None where it is empty or wrong, which is noted."""
    if text == "" and may_be_empty:
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        problems.append(f"line {line}: {column} is '{text}', not a number from {low} to {high}")
        return None
    return value


def read_table(path, problems):
    """The table's rows; what is wrong with them by themselves is added to the problems."""
    with open(path, encoding="utf-8", newline="") as file:
        lines = [(n, line.rstrip("\n")) for n, line in enumerate(file, 1)]
    lines = [(n, line) for n, line in lines if line and not line.startswith("#")]
    if not lines or lines[0][1].split(",") != COLUMNS:
        problems.append("the first line after the comments does not name the columns")
        return []
    rows, seen = [], {}
    for n, line in lines[1:]:
        if "\r" in line:
            problems.append(f"line {n}: ends in a carriage return")
        cells = next(csv.reader([line]))
        if len(cells) != len(COLUMNS):
            problems.append(f"line {n}: {len(cells)} cells, not {len(COLUMNS)}")
            continue
        row = dict(zip(COLUMNS, cells))
        if any(cell != cell.strip() for cell in cells):
            problems.append(f"line {n}: space around a cell")
        names = row["names"].split(";")
        for name in names:
            if not name or name != name.strip():
                problems.append(f"line {n}: empty name, or space around one: '{name}'")
            if key_of(name) in seen:
                problems.append(f"line {n}: the name '{name}' stands in line {seen[key_of(name)]} too")
            seen[key_of(name)] = n
        if row["kind"] not in KINDS:
            problems.append(f"line {n}: unknown kind '{row['kind']}'")
        if not row["source"]:
            problems.append(f"line {n}: no source")

        def cell(column, low, high, may_be_empty=True):
            return number(row[column], n, column, low, high, problems, may_be_empty)

        ra = cell("right_ascension_deg", 0, 360, False)
        dec = cell("declination_deg", -90, 90, False)
        major, minor = cell("major_arcmin", 0.005, 1000), cell("minor_arcmin", 0.005, 1000)
        angle = cell("position_angle_deg", 0, 179.99)
        inclination = cell("inclination_deg", 0, 90)
        distance = cell("distance_ly", 1, 1.4e10)
        if (major is None) != (minor is None):
            problems.append(f"line {n}: one axis without the other")
        elif major is not None and minor > major:
            problems.append(f"line {n}: minor axis longer than the major")
        elif angle is not None and (major is None or major == minor):
            problems.append(f"line {n}: an angle without a long axis")
        if inclination is not None and row["kind"] not in DISKS | {"other"}:
            problems.append(f"line {n}: inclination of a {row['kind']}")
        if ra is not None and dec is not None:
            rows.append({"line": n, "names": names, "kind": row["kind"], "ra": ra, "dec": dec, "major": major,
                         "minor": minor, "angle": angle, "inclination": inclination, "distance": distance})
    for prefix, last in (("M", 110), ("C", 109)):
        missing = [f"{prefix} {i}" for i in range(1, last + 1) if key_of(f"{prefix} {i}") not in seen]
        if missing:
            problems.append("missing: " + ", ".join(missing))
    return rows


def read_binary(data):
    """catalog.dat, unpacked: a version, an edition, then rows in the order of Qt's QDataStream."""
    at = 0

    def take(form):
        nonlocal at
        value, = struct.unpack_from(form, data, at)
        at += struct.calcsize(form)
        return value

    def text():
        nonlocal at
        length = take(">I")
        if length == 0xFFFFFFFF:
            return ""
        at += length
        return data[at - length:at].decode("utf-16-be")

    if not text().startswith("3."):
        sys.exit("this version of catalog.dat is not known here; take that of stellarium-data 0.22")
    text()
    while at < len(data):
        take(">I")
        entry = {"ra": math.degrees(take(">d")), "dec": math.degrees(take(">d"))}
        take(">d"), take(">d")
        kind = take(">I")
        entry.update(type=TYPES[kind] if kind < len(TYPES) else "", shape=text(), major=take(">d") * 60,
                     minor=take(">d") * 60, angle=take(">I"))
        for _ in range(4):
            take(">d")
        entry["distance"] = take(">d") * LIGHT_YEARS_PER_KILOPARSEC
        take(">d")
        entry.update({prefix: take(">I") for prefix in NUMBERS})
        text()
        entry["Arp"] = take(">I")
        for form in "IsssssssIIIII":
            text() if form == "s" else take(">I")
        yield entry


def read_text(data):
    """catalog.txt: columns between tabs; distances in kiloparsec, those of galaxies in older versions megaparsec."""
    galaxies_in = 1000 if b"Mpc for galaxies" in data else 1
    for line in data.decode("utf-8").splitlines():
        cells = [cell.strip() for cell in line.split("\t")]
        if line.startswith("#") or len(cells) < 16 + len(NUMBERS):
            continue
        value = [float(cell or 0) if re.fullmatch(r"[-+.\deE]*", cell) else 0 for cell in cells]
        scale = galaxies_in if "spiral" in CLASSES.get(cells[5].upper(), ()) else 1
        entry = {"ra": value[1], "dec": value[2], "type": cells[5].upper(), "shape": cells[6], "major": value[7],
                 "minor": value[8], "angle": value[9], "distance": value[14] * scale * LIGHT_YEARS_PER_KILOPARSEC}
        entry.update({prefix: int(value[16 + i]) for i, prefix in enumerate(NUMBERS)})
        yield entry


def read_catalogue(path):
    """The catalogue's entries by name, as 'ngc224'; a name may have several, the one to compare with first."""
    with open(path, "rb") as file:
        data = file.read()
    entries = read_binary(gzip.decompress(data)) if data[:2] == b"\x1f\x8b" else read_text(data)
    by_name = {}
    for entry in entries:
        for prefix, column in PREFIXES.items():
            if entry.get(column):
                by_name.setdefault(f"{prefix}{entry[column]}", []).append(entry)
    return by_name


def entry_of(row, by_name):
    """The entry of one of the row's names, by the first catalogue that has one."""
    keys = [key_of(name) for name in row["names"]]
    for prefix in PREFIXES:
        for key in keys:
            if re.fullmatch(prefix + r"\d+", key) and key in by_name:
                return by_name[key][0]
    return None


def shapes_of(shape):
    """What the type of a galaxy (SB(rs)bc, E2, S0...) allows; empty where it says nothing."""
    shape = re.sub(r"^[(\[]?R'?\d*[)\]]?", "", shape.strip().replace("(R)", "").replace("(R')", ""))
    if re.match(r"(E|cD|D\b)", shape):
        return {"elliptical", "lenticular"} if "S0" in shape or "/" in shape else {"elliptical"}
    if re.match(r"(SAB|SA|SB|S)\(?[a-z']*\)?0|L", shape):
        return {"lenticular"}
    if re.match(r"I", shape) or re.match(r"S(A|B|AB)?\([a-z]*\)m", shape):
        return {"irregular", "barred", "spiral"} if shape.startswith("S") else {"irregular"}
    if shape.startswith("SAB"):
        return {"spiral", "barred"}
    if shape.startswith("SB"):
        return {"barred"}
    return {"spiral"} if shape.startswith("SA") else {"spiral", "barred"} if re.match(r"S[a-d]", shape) else set()


def separation(a, b):
    """Degrees between two places of the sky."""
    r1, d1, r2, d2 = (math.radians(x) for x in (a["ra"], a["dec"], b["ra"], b["dec"]))
    half = math.sin((d1 - d2) / 2) ** 2 + math.cos(d1) * math.cos(d2) * math.sin((r1 - r2) / 2) ** 2
    return math.degrees(2 * math.asin(math.sqrt(half)))


def differences(row, entry, by_name):
    """What differs between a row and the catalogue's entry, as (what, in words)."""
    for name in row["names"]:
        away = min((separation(row, other) for other in by_name.get(key_of(name), ())), default=0)
        if away > max(0.1, (row["major"] or 0) / 60 / 2):
            yield "name", f"{name} is {away:.2f} degrees away"
    kinds = CLASSES.get(entry["type"])
    if kinds and row["kind"] not in kinds and row["kind"] != "other":
        yield "kind", f"{row['kind']}, Stellarium's type {entry['type']}"
    shapes = shapes_of(entry["shape"]) if kinds and "spiral" in kinds else set()
    if "barred" in shapes and (row["inclination"] or 0) >= 70:
        shapes = shapes | {"spiral"}  # a bar that is not seen
    if shapes and row["kind"] in DISKS | {"elliptical"} and row["kind"] not in shapes:
        yield "shape", f"{row['kind']}, Stellarium's type {entry['shape']}"
    away = separation(row, entry)
    if away > max(0.1, (row["major"] or 0) / 60 / 3):
        yield "place", f"{away:.2f} degrees away, size {row['major']} arcmin"
    if row["major"] and entry["major"] and not 0.5 <= row["major"] / entry["major"] <= 2:
        yield "size", f"{row['major']:g} arcmin, Stellarium {entry['major']:.3g}"
    narrow = row["minor"] and row["minor"] < 0.7 * row["major"] and 0 < entry["minor"] < 0.7 * entry["major"]
    if row["angle"] is not None and narrow and entry["angle"]:
        turn = abs(row["angle"] - entry["angle"]) % 180
        if min(turn, 180 - turn) > 20:
            yield "angle", f"{row['angle']:g} degrees, Stellarium {entry['angle']:g}"
    if row["distance"] and entry["distance"] > 0:
        ratio = row["distance"] / entry["distance"]
        if not 1 / 1.6 <= ratio <= 1.6:
            yield "distance", f"{row['distance']:.3g} light years, Stellarium {entry['distance']:.3g}"


def main(arguments):
    if len(arguments) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    problems = []
    rows = read_table(arguments[1], problems)
    print(f"{len(rows)} rows, {sum(len(row['names']) for row in rows)} names")
    if len(arguments) == 3:
        by_name = read_catalogue(arguments[2])
        known, found, explained = reasons(), 0, set()
        for row in rows:
            entry = entry_of(row, by_name)
            found += entry is not None
            for what, words in differences(row, entry, by_name) if entry else ():
                why = known.get((row["names"][0], what))
                if why:
                    explained.add((row["names"][0], what))
                    print(f"explained: {row['names'][0]}, {what}: {words}. {why}")
                else:
                    problems.append(f"line {row['line']}, {row['names'][0]}, {what}: {words}")
        print(f"{found} rows found in the catalogue, {len(explained)} differences explained")
        for name, what in sorted(known.keys() - explained):
            print(f"explained in vain: {name}, {what}")
    for problem in problems:
        print(problem, file=sys.stderr)
    print(f"{len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
