"""Reads what spidar_paper wrote."""

import csv
import os


class Tables:
    """The CSV files of one run."""

    def __init__(self, folder):
        self.folder = folder
        self.read = {}
        self.curves = {}
        self.figures = {row["figure"]: row["value"] for row in self.rows("figures")}

    def rows(self, name, **wanted):
        """Rows of NAME.csv as dictionaries; wanted: column=value, compared as number or text."""
        if name not in self.read:
            path = os.path.join(self.folder, name + ".csv")
            with open(path, newline="", encoding="utf-8") as file:
                self.read[name] = list(csv.DictReader(file))
        return [row for row in self.read[name]
                if all(same(row[key], value) for key, value in wanted.items())]

    def columns(self, name, *columns, **wanted):
        """Columns of the wanted rows as lists of numbers."""
        rows = self.rows(name, **wanted)
        if not rows:
            raise KeyError(f"{name}.csv has no row with {wanted}")
        return [[float(row[column]) for row in rows] for column in columns]

    def number(self, figure):
        return float(self.figures[figure])

    def capacity(self, figure, weighting, max_tension_n, asked):
        """{place: capacity} of one curve."""
        key = (figure, weighting, max_tension_n, asked)
        if key not in self.curves:
            at, values = self.columns("capacity", "at", "capacity", figure=figure,
                                      weighting=weighting, max_tension_n=max_tension_n, asked=asked)
            self.curves[key] = dict(zip(at, values))
        return self.curves[key]


def same(text, value):
    if isinstance(value, str):
        return text == value
    return abs(float(text) - value) < 1e-9
