"""A scene becomes an outcome; given radii become arrays; what accuracy costs."""
