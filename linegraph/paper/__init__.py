"""The matrices of Boiadzhiev and Lilov, literally, to be compared with."""
