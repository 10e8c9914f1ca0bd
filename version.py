"""The one place that holds the version of spidar_g."""

version = "0.1.0"
