# a thousand changed bytes of products, scripts and photos, each named by `make verify`
export CHANGES=1000
. tests/pipeline/verify.sh
